#pragma once
// Published experiments. A bench is one file, bench_NAME.cpp: it declares its cases, algorithms, metrics and published
// figures, and a function from one trial to its metrics. The runner here does the rest: threads, shards, tables.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "context.hpp"
#include "report/bench_result.hpp"

namespace outrider::app {

/// One cell of an experiment.
struct Trial {
  std::string case_name;
  int number = 1;           ///< from 1
  std::string algorithm;
  std::uint64_t seed = 0;   ///< of (command's seed, case, number): the same for every algorithm, so that trials pair
  const std::atomic<bool>* interrupted = nullptr;  ///< when set, return soon; the row is dropped
};

struct Outcome {
  report::Metrics metrics;                      ///< a subset of the design's; nullopt: never reached
  report::Json extra = report::Json::object();  ///< further keys of the row
};

struct Experiment {
  report::BenchDesign design;
  /// Called from several threads at once; the outcome follows from the trial alone. Nothing: the algorithm does not
  /// apply to this case, and there is no row.
  std::function<std::optional<Outcome>(const Trial&)> run;
  /// Adds what needs all rows of one trial, such as ratios between algorithms. May be empty.
  std::function<void(std::vector<report::BenchRow>&)> complete;
  bool serial = false;  ///< measures wall-clock time: one trial at a time, whatever --jobs
};

struct BenchArguments {
  std::optional<int> trials;  ///< --trials
  std::uint64_t seed = 1;     ///< --seed
};
using BuildExperiment = std::function<Experiment(const BenchArguments&)>;

struct BenchInfo {
  std::string name;
  std::string one_line;
  /// Adds the bench's own options to its command line; what it returns is called once these are read.
  BuildExperiment (*declare)(CLI::App& verb) = nullptr;
  std::vector<report::Table> (*tables)(const report::BenchResult&) = nullptr;  ///< the paper's layout, shown first
  std::string (*figures)(const report::BenchResult&) = nullptr;               ///< HTML
  report::Json (*json)(const report::BenchResult&) = nullptr;                 ///< in place of bench_json, for --json
};

/// All benches, in the order of `outrider list benches`.
const std::vector<BenchInfo>& benches();

/// Part `index` of `of` (from 1) of all trials; a trial's algorithms stay together.
struct Shard {
  int index = 1;
  int of = 1;
};

/// Runs an experiment on `jobs` threads. The result does not depend on `jobs`; `progress(done, all)` is called by one
/// thread at a time. What a trial throws ends the run and comes out here.
report::BenchResult run_experiment(const Experiment& experiment, std::uint64_t seed, int jobs, Shard shard,
                                   const std::atomic<bool>& interrupted,
                                   const std::function<void(std::size_t, std::size_t)>& progress);

/// "i/n" -> a shard; "" is the whole. Throws InputError.
Shard parse_shard(const std::string& text);

/// Joins the --json results of all shards, as files, into the whole. Throws InputError naming the file.
report::BenchResult merge_files(const std::vector<std::string>& files);

/// Shows a result as --json, or its tables; writes rows.csv, tables.txt, report.html and `json_name` into --out.
void show_result(const report::BenchResult& result, const std::string& json_name, Context& ctx);

/// The seed of a trial: of the command's seed, the case and the number.
std::uint64_t trial_seed(std::uint64_t seed, const std::string& case_name, int number);

/// Adds `ratio_oracle`: each row's time_s over that of the trial's `oracle`, where there is one.
void add_oracle_ratio(std::vector<report::BenchRow>& trial);

// One file a bench.
BenchInfo bench_dai2014();
BenchInfo bench_explore_bench();
BenchInfo bench_oracle();
BenchInfo bench_speed();
BenchInfo bench_matignon2012();
BenchInfo bench_lozenguez_time();
BenchInfo bench_lozenguez_modifications();
BenchInfo bench_lozenguez_gain();

}  // namespace outrider::app
