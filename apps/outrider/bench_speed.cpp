// How fast the parts are, with floors and plain references in the same run; docs/performance.md.

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <limits>

#include "bench.hpp"
#include "maps_module.hpp"

namespace outrider::app {
namespace {

using report::BenchResult;
using report::Json;

constexpr int kTrials = 3;
constexpr double kLeastS = 0.3;  // of CPU time a measurement goes on for
constexpr int kFewest = 3;       // repetitions in it

double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The least CPU and wall-clock time of a repetition [ms]: what disturbs a measurement only ever adds to it.
Outcome measure(const Work& work, const Trial& trial) {
  const auto once = work.prepare();
  once();  // pages and caches
  double least_cpu = std::numeric_limits<double>::infinity(), least_wall = least_cpu, sum = 0.0;
  int repetitions = 0;
  while ((sum < kLeastS || repetitions < kFewest) && !trial.interrupted->load()) {
    const auto wall = std::chrono::steady_clock::now();
    const double begin = cpu_s();
    once();
    const double took = cpu_s() - begin;
    const std::chrono::duration<double> real = std::chrono::steady_clock::now() - wall;
    least_cpu = std::min(least_cpu, took);
    least_wall = std::min(least_wall, real.count());
    sum += took;
    ++repetitions;
  }
  return {{{"cpu_ms", 1e3 * least_cpu}, {"wall_ms", 1e3 * least_wall}}, {{"repetitions", repetitions}}};
}

std::string duration(double ms) {
  return ms >= 100.0 ? fmt::format("{:.0f} ms", ms)
         : ms >= 0.1 ? fmt::format("{:.3g} ms", ms)
                     : fmt::format("{:.3g} µs", 1e3 * ms);
}

/// One line a job: ours, and how far from the floor and ahead of the references.
std::vector<report::Table> tables(const BenchResult& result) {
  report::Table table{"Speed: least CPU time",
                      {"work", "outrider", "floor", "opencv", "plain"},
                      {},
                      "in brackets: of ours; a floor is what no implementation goes below"};
  for (const auto& c : result.design.cases) {
    const auto least = [&](const std::string& algorithm) {
      double ms = std::numeric_limits<double>::infinity();
      for (const auto& row : result.rows)
        if (row.case_name == c.name && row.algorithm == algorithm) ms = std::min(ms, row.metric("cpu_ms").value_or(ms));
      return ms;
    };
    const double ours = least("outrider");
    std::vector<std::string> row{c.name, std::isfinite(ours) ? duration(ours) : ""};
    for (const char* other : {"floor", "opencv", "plain"}) {
      const double ms = least(other);
      row.push_back(std::isfinite(ms) ? fmt::format("{} ({:.3g} x)", duration(ms), ms / ours) : "");
    }
    table.rows.push_back(std::move(row));
  }
  double load[1] = {0.0};
  if (getloadavg(load, 1) == 1)
    table.note += fmt::format("; load of the machine {:.1f} on {} cores", load[0], sysconf(_SC_NPROCESSORS_ONLN));
  return {std::move(table)};
}

/// Google Benchmark's layout, so that its tools (compare.py) read it.
Json google_json(const BenchResult& result) {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  double load[3] = {};
  const int loads = getloadavg(load, 3);
  Json list = Json::array();
  for (const auto& row : result.rows)
    list.push_back({{"name", fmt::format("{}/{}", row.case_name, row.algorithm)},
                    {"run_name", fmt::format("{}/{}", row.case_name, row.algorithm)},
                    {"run_type", "iteration"},
                    {"repetitions", result.design.cases.front().trials},
                    {"repetition_index", row.trial - 1},
                    {"threads", 1},
                    {"iterations", row.extra.value("repetitions", 1)},
                    {"real_time", row.metric("wall_ms").value_or(0.0)},
                    {"cpu_time", row.metric("cpu_ms").value_or(0.0)},
                    {"time_unit", "ms"}});
  return {{"context",
           {{"date", fmt::format("{:%Y-%m-%dT%H:%M:%S+00:00}", fmt::gmtime(std::time(nullptr)))},
            {"host_name", host},
            {"executable", "outrider bench speed"},
            {"num_cpus", sysconf(_SC_NPROCESSORS_ONLN)},
            {"load_avg", loads > 0 ? Json(std::vector<double>(load, load + loads)) : Json::array()},
            {"library_build_type", "release"}}},
          {"benchmarks", std::move(list)}};
}

Experiment experiment_of(const BenchArguments& arguments) {
  auto works = std::make_shared<std::vector<Work>>(maps_module().speed_works());
  Experiment e;
  e.serial = true;
  e.design.bench = "speed";
  for (const Work& work : *works)
    if (e.design.cases.empty() || e.design.cases.back().name != work.case_name)
      e.design.cases.push_back({work.case_name, "", arguments.trials.value_or(kTrials)});
  e.design.algorithms = {{"outrider", ""},
                         {"floor", "what no implementation goes below"},
                         {"opencv", "the same job by OpenCV, one thread"},
                         {"plain", "the obvious implementation"}};
  e.design.metrics = {{"cpu_ms", "ms", 4, false}, {"wall_ms", "ms", 4, false}};
  for (const Work& work : *works)
    e.design.notes.push_back(fmt::format("{}: {}: {}", work.case_name, work.algorithm, work.about));
  e.run = [works](const Trial& trial) -> std::optional<Outcome> {
    for (const Work& work : *works)
      if (work.case_name == trial.case_name && work.algorithm == trial.algorithm) return measure(work, trial);
    return std::nullopt;
  };
  return e;
}

BuildExperiment declare(CLI::App&) {
  return [](const BenchArguments& arguments) { return experiment_of(arguments); };
}

}  // namespace

BenchInfo bench_speed() {
  return {"speed", "how fast the parts are, beside floors and references; --json in Google Benchmark's layout",
          declare, tables,
          nullptr, google_json};
}

}  // namespace outrider::app
