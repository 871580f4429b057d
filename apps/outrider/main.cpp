// The command line: verbs, common flags, exit codes. What a verb does lives in its own file.

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "context.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::app {

CLI::Validator number_in(double low, double high) {
  return {[low, high](std::string& text) {
            double value = 0.0;
            const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
            const bool ok = error == std::errc() && end == text.data() + text.size() && value >= low && value <= high;
            return ok ? std::string() : fmt::format("expected a number from {} to {}, not '{}'", low, high, text);
          },
          fmt::format("in [{} - {}]", low, high)};
}

namespace {

/// CLI11 would read -1, and all that is too large, as the largest seed there is.
const CLI::Validator kWholeNumber{[](std::string& text) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool ok = error == std::errc() && end == text.data() + text.size();
  return ok ? std::string() : fmt::format("expected a whole number from 0 to 2^64 - 1, not '{}'", text);
}, ""};

/// An empty name is most often a shell variable that was never set; the run would be lost.
const CLI::Validator kNotEmpty{[](std::string& text) {
  return text.empty() ? std::string("expected the name of a folder, not nothing") : std::string();
}, ""};

}  // namespace

void add_output_flags(CLI::App& verb, Context& ctx) {
  verb.add_flag("--json", ctx.json, "print the result as one JSON document on stdout");
  verb.add_flag("-q,--quiet", ctx.quiet, "no progress, no summary");
  verb.add_flag("-v,--verbose", ctx.verbose, "say more on stderr");
}

void add_work_flags(CLI::App& verb, Context& ctx) {
  add_output_flags(verb, ctx);
  verb.add_option("--out", ctx.out, "run folder to write; must not exist or be empty")->check(kNotEmpty)->type_name("DIR");
  verb.add_flag("--force", ctx.force, "replace an existing run folder");
  verb.add_option("--jobs", ctx.jobs, "threads; results do not depend on it")
      ->check(CLI::Range(1, 1024))->capture_default_str()->type_name("N");
}

void add_run_flags(CLI::App& verb, Context& ctx) {
  add_work_flags(verb, ctx);
  verb.add_option("--seed", ctx.seed, "every random choice comes from it")
      ->check(kWholeNumber)->capture_default_str()->type_name("N");
}

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
  add_replay(app, ctx);
  add_report(app, ctx);
  add_bench(app, ctx);
  add_sweep(app, ctx);
  add_map(app, ctx);
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
