// `outrider report RUN...`: the key figures of one run, or several side by side.

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <memory>
#include <set>

#include "context.hpp"
#include "report/comparison.hpp"
#include "report/figures.hpp"
#include "report/why.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::app {
namespace {

namespace fs = std::filesystem;

/// DIR/report.html, or the file itself when it ends in .html; an existing file needs --force.
fs::path page_path(const Context& ctx) {
  const bool is_file = ctx.out.extension() == ".html" || ctx.out.extension() == ".htm";
  const fs::path page = is_file ? ctx.out : ctx.out / "report.html";
  if (fs::exists(page) && !ctx.force)
    throw InputError(fmt::format("--out {}: exists; choose another name, or --force to replace it", page.string()));
  return page;
}

std::vector<report::RunSummary> load_runs(const std::vector<std::string>& folders) {
  std::vector<report::RunSummary> runs;
  std::set<std::string> names;
  for (const std::string& folder : folders) {
    runs.push_back(report::load_run(folder));
    names.insert(runs.back().name);
  }
  if (names.size() < runs.size())  // the last part of the path does not tell them apart
    for (report::RunSummary& run : runs) run.name = run.dir.string();
  return runs;
}

void print_tables(const std::vector<report::RunSummary>& runs, const Context& ctx) {
  std::vector<report::Json> documents;
  std::vector<std::string> names;
  for (const report::RunSummary& run : runs) {
    documents.push_back(run.run);
    names.push_back(run.name);
  }
  if (runs.size() == 1) {
    names.clear();
    fmt::print("{}\n\n", report::verdict(documents[0]));
  }
  fmt::print("{}", report::figure_table(report::figure_rows(documents), names));
  if (ctx.quiet || runs.size() > 1) return;
  if (fs::exists(runs[0].dir / "report.html")) fmt::print("\nreport: {}\n", (runs[0].dir / "report.html").string());
}

std::vector<report::Json> read_events(const fs::path& path) {
  std::ifstream file(path);
  if (!file) throw InputError(fmt::format("{}: cannot be read; --why needs the events of a run", path.string()));
  std::vector<report::Json> events;
  std::string line;
  for (std::size_t n = 1; std::getline(file, line); ++n) {
    events.push_back(report::Json::parse(line, nullptr, false));
    if (!events.back().is_object()) throw InputError(fmt::format("{}:{}: expected an event as JSON", path.string(), n));
  }
  return events;
}

/// --why ROBOT@T: why did that robot go where it was heading for at that time?
void explain(const std::vector<std::string>& folders, const std::string& question, const Context& ctx) {
  const auto at = question.rfind('@');
  double t = 0.0;
  const char* end = question.data() + question.size();
  const char* begin = at == std::string::npos ? end : question.data() + at + 1;
  const auto [rest, error] = std::from_chars(begin, end, t);
  if (error != std::errc() || rest != end || !(t >= 0.0))
    throw InputError(fmt::format("--why {}: expected ROBOT@T with T in seconds, as in R2@40", question));
  if (folders.size() != 1) throw InputError("--why: expected one run folder");
  const report::RunSummary run = report::load_run(folders[0]);
  const std::string robot = question.substr(0, at);
  std::vector<std::string> names;
  for (const report::Json& member : run.run["team"]) names.push_back(member.value("name", std::string()));
  if (std::find(names.begin(), names.end(), robot) == names.end())
    throw InputError(fmt::format("--why {}: no robot '{}'{}", question, robot, suggestion(robot, names)));
  const report::Json answer = report::why(read_events(run.dir / "events.jsonl"), robot, t);
  fmt::print("{}", ctx.json ? report::to_text(answer, 2) + '\n' : report::why_text(answer));
}

void run_report(const std::vector<std::string>& folders, Context& ctx) {
  const fs::path page = ctx.out.empty() ? fs::path() : page_path(ctx);  // refuse before reading
  const std::vector<report::RunSummary> runs = load_runs(folders);
  if (ctx.json)
    fmt::print("{}\n", report::to_text(report::comparison_json(runs), 2));
  else
    print_tables(runs, ctx);
  if (page.empty()) return;
  if (page.has_parent_path()) fs::create_directories(page.parent_path());
  report::write_file(page, report::comparison_html(runs));
  if (!ctx.quiet) fmt::print(ctx.json ? stderr : stdout, "\ncomparison: {}\n", page.string());
}

}  // namespace

void add_report(CLI::App& app, Context& ctx) {
  CLI::App* verb = app.add_subcommand("report", "key figures of a run folder, or a comparison of several");
  const auto folders = std::make_shared<std::vector<std::string>>();
  verb->add_option("RUN", *folders, "run folders, made with --out")->required()->type_name("DIR ...");
  verb->add_option("--out", ctx.out, "write a page that compares the runs: FILE.html, or DIR/report.html");
  verb->add_flag("--force", ctx.force, "replace an existing page");
  const auto question = std::make_shared<std::string>();
  verb->add_option("--why", *question, "why a robot went where it was heading for at time T [s]: the auction and its bids")
      ->type_name("ROBOT@T");
  add_output_flags(*verb, ctx);
  verb->callback([folders, question, &ctx] {
    question->empty() ? run_report(*folders, ctx) : explain(*folders, *question, ctx);
  });
}

}  // namespace outrider::app
