#pragma once
// The result of a bench: a design (cases x trials x algorithms), its rows, and what follows from them.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "report/run_record.hpp"
#include "report/table.hpp"

namespace outrider::report {

struct BenchCase {
  std::string name;
  std::string map;   ///< of every row of the case
  int trials = 0;    ///< numbered from 1
};

struct BenchAlgorithm {
  std::string name;
  std::string about;  ///< its setting, in words
};

struct BenchMetric {
  std::string name;
  std::string unit;
  int digits = 1;      ///< behind the point, in tables
  bool tested = true;  ///< gets t-tests
  bool shown = true;   ///< gets a column in the tables
};

/// A figure that somebody published.
struct PublishedFigure {
  std::string case_name, algorithm, metric;
  double value = 0.0;
};

/// What a bench sets out to do. Rows are numbered case by case, trial by trial, algorithm by algorithm.
struct BenchDesign {
  std::string bench;
  std::vector<BenchCase> cases;
  std::vector<BenchAlgorithm> algorithms;
  std::vector<BenchMetric> metrics;
  std::vector<std::string> references;      ///< algorithms that all others are tested against
  std::vector<PublishedFigure> published;
  Json options = Json::object();            ///< what else determines the result
  std::vector<std::string> notes;           ///< below the tables

  const BenchMetric* metric(const std::string& name) const;
};

using Metrics = std::vector<std::pair<std::string, std::optional<double>>>;

struct BenchRow {
  std::string case_name;
  int trial = 0;
  std::string algorithm;
  Metrics metrics;              ///< nullopt: never reached
  Json extra = Json::object();  ///< further keys of the row
  std::optional<double> metric(const std::string& name) const;
};

struct BenchResult {
  BenchDesign design;
  std::uint64_t seed = 1;
  std::vector<BenchRow> rows;
  std::string shard;         ///< "i/n"; "" = whole
  bool interrupted = false;  ///< rows are missing
  Json timing = Json::object();
};

/// One metric of one algorithm in one case. NaN where rows are too few.
struct BenchSummary {
  std::string case_name, algorithm, metric;
  std::size_t n = 0;        ///< rows that have the metric
  std::size_t missing = 0;  ///< rows in which it was never reached
  double mean = 0.0, std = 0.0, lo = 0.0, hi = 0.0;  ///< unbiased std, 95 % t interval
  std::optional<double> published;
};

std::vector<BenchSummary> summarise(const BenchResult& result);

/// Values of a metric of two algorithms in the trials of a case in which both have it.
struct PairedValues {
  std::vector<double> a, b;
};
PairedValues paired_values(const BenchResult& result, const std::string& case_name, const std::string& metric,
                           const std::string& a, const std::string& b);

/// {"bench", "seed", "options", "rows", "summary", "tests", "design", "notes", "timing"}: docs/benches.md.
Json bench_json(const BenchResult& result);

/// Reads what bench_json wrote. `source` names the file in errors (InputError).
BenchResult parse_bench(const Json& json, const std::string& source);

/// Joins the shards of one bench into exactly the unsharded result. Throws InputError, naming the source, when they are
/// not shards of the same command, or when one is missing or double.
BenchResult merge_benches(std::vector<BenchResult> parts, std::span<const std::string> sources);

/// A table a case with the shown metrics as "mean ± std", published means beside them, then the tests.
std::vector<Table> bench_tables(const BenchResult& result);

/// One line a row: case, map, trial, algorithm, metrics.
std::string bench_csv(const BenchResult& result);

/// A self-contained page: `figures` is HTML put between the heading and the tables.
std::string bench_html(const BenchResult& result, std::span<const Table> tables, const std::string& figures);

}  // namespace outrider::report
