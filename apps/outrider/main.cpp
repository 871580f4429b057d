// The command line: verbs, common flags, exit codes. What a verb does lives in its own file.

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "context.hpp"
#include "maps_module.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::app {

namespace {

std::atomic<bool> interrupted{false};  // the one global: a signal handler has no other way to speak

extern "C" void on_interrupt(int signal) {
  if (interrupted.exchange(true)) {  // a second Ctrl-C aborts
    std::signal(signal, SIG_DFL);
    std::raise(signal);
  }
}

const CLI::App* verb_called(const CLI::App& app, const std::string& name) {
  for (const auto* sub : app.get_subcommands(nullptr))
    if (sub->get_name() == name) return sub;
  return nullptr;
}

/// The verb and flag names a mistyped word may have been meant to be.
std::string usage_hint(const CLI::App& app, const std::vector<std::string>& argv) {
  const CLI::App* verb = verb_called(app, argv.size() > 1 ? argv[1] : "");
  if (verb == nullptr && argv.size() > 1 && !argv[1].starts_with("-")) {
    std::vector<std::string> verbs;
    for (const auto* sub : app.get_subcommands(nullptr)) verbs.push_back(sub->get_name());
    return fmt::format("unknown verb '{}'{}", argv[1], suggestion(argv[1], verbs));
  }
  if (verb == nullptr) verb = &app;
  if (const auto subs = verb->get_subcommands(nullptr); !subs.empty() && argv.size() > 2) {
    std::vector<std::string> names;
    for (const auto* sub : subs) names.push_back(sub->get_name());
    const CLI::App* sub = verb_called(*verb, argv[2]);
    if (sub == nullptr && !argv[2].starts_with("-") && argv.size() > 1 && verb != &app)
      return fmt::format("unknown {} '{}'{}", argv[1], argv[2], suggestion(argv[2], names));
    if (sub != nullptr) verb = sub;
  }
  std::vector<std::string> flags;
  for (const auto* option : verb->get_options())
    for (const auto& name : option->get_lnames()) flags.push_back("--" + name);
  for (std::size_t i = 1; i < argv.size(); ++i) {
    const std::string flag = argv[i].substr(0, argv[i].find('='));
    if (flag.starts_with("--") && flag.size() > 2 && std::find(flags.begin(), flags.end(), flag) == flags.end())
      return fmt::format("unknown option '{}'{}", flag, suggestion(flag, flags));
  }
  return "";
}

/// The verbs of the maps module, which is loaded only when one of them is called.
void add_module_verbs(CLI::App& app, Context& ctx) {
  constexpr std::array kVerbs{kReplay, kMap};
  const std::string called = ctx.argv.size() > 1 ? ctx.argv[1] : "";
  if (std::any_of(kVerbs.begin(), kVerbs.end(), [&](const ModuleVerb& verb) { return called == verb.name; }))
    return maps_module().add_verbs(app, ctx);
  for (const ModuleVerb& verb : kVerbs) app.add_subcommand(verb.name, verb.about);
}

int run(int argc, char** argv) {
  Context ctx;
  ctx.argv.assign(argv, argv + argc);
  ctx.interrupted = &interrupted;
  CLI::App app{"Outrider maps unknown places with a team of robots.", "outrider"};
  app.set_version_flag("--version", std::string("outrider ") + OUTRIDER_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer("outrider VERB --help explains a verb. Exit codes: 0 done, 1 aim not reached, 2 bad usage or input, "
             "130 interrupted.");
  add_explore(app, ctx);
  add_module_verbs(app, ctx);
  add_robot(app, ctx);
  add_team(app, ctx);
  add_watch(app, ctx);
  add_allocate(app, ctx);
  add_report(app, ctx);
  add_bench(app, ctx);
  add_sweep(app, ctx);
  add_list(app, ctx);
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& e) {  // --help, --version
    return app.exit(e);
  } catch (const CLI::ParseError& e) {
    const std::string hint = usage_hint(app, ctx.argv);
    fmt::print(stderr, "outrider: {}\nSee 'outrider {}--help'.\n", hint.empty() ? e.what() : hint,
               argc > 1 && verb_called(app, argv[1]) != nullptr ? std::string(argv[1]) + " " : "");
    return kBadInput;
  }
  return ctx.exit_code;
}

}  // namespace
}  // namespace outrider::app

int main(int argc, char** argv) {
  std::signal(SIGINT, outrider::app::on_interrupt);
  std::signal(SIGTERM, outrider::app::on_interrupt);
  std::signal(SIGPIPE, SIG_IGN);
  try {
    const int code = outrider::app::run(argc, argv);
    if (std::fflush(stdout) == 0) return code;
    fmt::print(stderr, "outrider: cannot write the result to stdout: {}\n", std::strerror(errno));
    return outrider::app::kAimMissed;
  } catch (const outrider::InputError& e) {
    fmt::print(stderr, "outrider: {}\n", e.what());
    return outrider::app::kBadInput;
  } catch (const std::exception& e) {
    fmt::print(stderr, "outrider: {}\n", e.what());
    return outrider::app::kAimMissed;
  }
}
