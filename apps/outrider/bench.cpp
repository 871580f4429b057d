// `outrider bench`: runs a published experiment, or joins the parts of one that ran in shards.

#include "bench.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <fstream>

#include "progress.hpp"
#include "report/run_folder.hpp"
#include "world/error.hpp"

namespace outrider::app {
namespace {

using report::BenchResult;

constexpr const char* kResultFile = "bench.json";

struct Options {
  std::optional<int> trials;
  std::string shard;
  std::filesystem::path csv;
  std::vector<std::string> merge;
};

const BenchInfo* info_of(const std::string& name) {
  for (const BenchInfo& info : benches())
    if (info.name == name) return &info;
  return nullptr;
}

std::vector<report::Table> all_tables(const BenchResult& result) {
  std::vector<report::Table> tables;
  const BenchInfo* info = info_of(result.design.bench);
  if (info != nullptr && info->tables != nullptr) tables = info->tables(result);
  for (report::Table& table : report::bench_tables(result)) tables.push_back(std::move(table));
  return tables;
}

std::string text_of(const BenchResult& result, const std::vector<report::Table>& tables) {
  std::string text;
  for (const report::Table& table : tables) text += table_text(table) + '\n';
  for (const auto& a : result.design.algorithms)
    if (!a.about.empty()) text += fmt::format("{}: {}\n", a.name, a.about);
  for (const std::string& note : result.design.notes) text += fmt::format("* {}\n", note);
  return text;
}

void write_folder(const BenchResult& result, const std::vector<report::Table>& tables, const std::filesystem::path& dir,
                  const std::string& json_name) {
  const BenchInfo* info = info_of(result.design.bench);
  const std::string figures = info != nullptr && info->figures != nullptr ? info->figures(result) : std::string();
  std::filesystem::create_directories(dir);
  report::write_file(dir / "rows.csv", bench_csv(result));
  report::write_file(dir / "tables.txt", text_of(result, tables));
  report::write_file(dir / "report.html", bench_html(result, tables, figures));
  report::write_file(dir / json_name, report::to_text(bench_json(result), 2) + '\n');
}

void run(const BuildExperiment& build, const Options& o, Context& ctx) {
  const Shard shard = parse_shard(o.shard);
  if (!ctx.out.empty()) report::check_out_dir(ctx.out, ctx.force);
  const Experiment experiment = build({o.trials, ctx.seed});
  Progress progress("bench " + experiment.design.bench, ctx.quiet);
  const auto begin = std::chrono::steady_clock::now();
  BenchResult result =
      run_experiment(experiment, ctx.seed, ctx.jobs, shard, *ctx.interrupted, [&](std::size_t done, std::size_t all) {
        progress.update(static_cast<double>(done) / static_cast<double>(all), fmt::format("{} of {}", done, all));
      });
  result.timing["wall_s"] = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!o.csv.empty()) report::write_file(o.csv, bench_csv(result));
  show_result(result, kResultFile, ctx);
}

void merge(const Options& o, Context& ctx) {
  if (!ctx.out.empty()) report::check_out_dir(ctx.out, ctx.force);
  const BenchResult result = merge_files(o.merge);
  if (!o.csv.empty()) report::write_file(o.csv, bench_csv(result));
  show_result(result, kResultFile, ctx);
}

}  // namespace

Shard parse_shard(const std::string& text) {
  Shard shard;
  int length = 0;
  if (text.empty()) return shard;
  if (std::sscanf(text.c_str(), "%d/%d%n", &shard.index, &shard.of, &length) != 2 ||
      length != static_cast<int>(text.size()) || shard.index < 1 || shard.of < shard.index)
    throw InputError(fmt::format("--shard {}: expected i/n with 1 <= i <= n, as in 2/4", text));
  return shard;
}

BenchResult merge_files(const std::vector<std::string>& files) {
  std::vector<BenchResult> parts;
  for (const std::string& name : files) {
    std::ifstream file(name);
    if (!file || std::filesystem::is_directory(name)) throw InputError(name + ": cannot read the file");
    report::Json json = report::Json::parse(file, nullptr, false);
    if (json.is_discarded()) throw InputError(name + ": not JSON; expected a result of 'outrider bench ... --json'");
    parts.push_back(report::parse_bench(json, name));
  }
  return report::merge_benches(std::move(parts), files);
}

void show_result(const BenchResult& result, const std::string& json_name, Context& ctx) {
  const auto tables = all_tables(result);
  if (!ctx.out.empty()) write_folder(result, tables, ctx.out, json_name);
  if (ctx.json) {
    const BenchInfo* info = info_of(result.design.bench);
    const bool own = info != nullptr && info->json != nullptr;
    fmt::print("{}\n", report::to_text(own ? info->json(result) : bench_json(result), 2));
  } else if (!ctx.quiet) {
    fmt::print("{}", text_of(result, tables));
    if (!ctx.out.empty()) fmt::print("report: {}\n", (ctx.out / "report.html").string());
  }
  if (result.interrupted) {
    fmt::print(stderr, "outrider: interrupted; {} rows are there\n", result.rows.size());
    ctx.exit_code = kInterrupted;
  }
}

const std::vector<BenchInfo>& benches() {
  static const std::vector<BenchInfo> all{
      bench_dai2014(),          bench_matignon2012(),           bench_lozenguez_time(), bench_lozenguez_modifications(),
      bench_lozenguez_gain(),   bench_explore_bench(),          bench_oracle(),         bench_speed()};
  return all;
}

void add_bench(CLI::App& app, Context& ctx) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("bench", "a published experiment, side by side with its published figures");
  verb->footer("outrider bench NAME --help shows a bench's own options.");
  verb->add_option("--merge", o->merge, "join the --json results of all shards into the whole")->type_name("FILE...");
  add_run_flags(*verb, ctx);
  verb->add_option("--csv", o->csv, "also write the rows to this file")->type_name("FILE");
  verb->require_subcommand(0, 1);
  for (const BenchInfo& info : benches()) {
    CLI::App* sub = verb->add_subcommand(info.name, info.one_line);
    sub->add_option("--trials", o->trials, "at most this many trials a case")->check(CLI::Range(1, 1000000))->type_name("N");
    sub->add_option("--shard", o->shard, "compute part i of n only")->type_name("i/n");
    sub->add_option("--csv", o->csv, "also write the rows to this file")->type_name("FILE");
    add_run_flags(*sub, ctx);
    const BuildExperiment build = info.declare(*sub);
    sub->callback([build, o, &ctx] { run(build, *o, ctx); });
  }
  verb->callback([verb, o, &ctx] {
    if (!verb->get_subcommands().empty()) {
      if (!o->merge.empty()) throw InputError("--merge: joins results; it runs no bench");
      return;
    }
    if (o->merge.empty()) {
      std::string names;
      for (const BenchInfo& info : benches()) names += (names.empty() ? "" : ", ") + info.name;
      throw InputError("bench: expected a name (" + names + ") or --merge FILE...");
    }
    merge(*o, ctx);
  });
}

}  // namespace outrider::app
