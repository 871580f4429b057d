// `outrider report RUN...`: the key figures of one run, or several side by side.

#include <fmt/format.h>

#include <memory>
#include <set>

#include "context.hpp"
#include "report/comparison.hpp"
#include "report/figures.hpp"
#include "world/error.hpp"

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
  add_output_flags(*verb, ctx);
  verb->callback([folders, &ctx] { run_report(*folders, ctx); });
}

}  // namespace outrider::app
