// Lozenguez et al. 2015, Fig. 7: modifications of its tasks that a robot sees, n robots with 4 n goals. docs/benches.md.

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "bench.hpp"
#include "bench_lozenguez.hpp"
#include "explorer/allocation_run.hpp"
#include "explorer/mission_draw.hpp"

namespace outrider::app {
namespace {

constexpr int kDraws = 200, kTasksEach = 4;
constexpr double kLongest = 4.0;

Outcome run_trial(const decision::TopologicalMap& map, const Trial& trial) {
  const int robots = std::stoi(trial.case_name.substr(1));
  const auto mission = explorer::draw_mission(map, kTasksEach * robots, robots, explorer::Starts::kApart, trial.seed);
  explorer::TeamCosts costs(mission, false);
  explorer::AllocationSettings s{.seed = trial.seed};
  s.protocol = trial.algorithm == "ssa" ? explorer::Protocol::kSsa : explorer::Protocol::kDssa;
  const auto result = explorer::allocate(mission, costs, s);
  const double sum = std::accumulate(result.modifications.begin(), result.modifications.end(), 0.0);
  return {{{"mean", sum / robots},
           {"max", static_cast<double>(*std::max_element(result.modifications.begin(), result.modifications.end()))},
           {"messages", static_cast<double>(result.messages)}},
          {{"iterations", result.iterations}}};
}

BuildExperiment declare(CLI::App&) {
  return [](const BenchArguments& arguments) {
    const auto map = lozenguez_map("urban", kLongest);
    Experiment e;
    e.design.bench = "lozenguez2015-modifications";
    for (int n = 2; n <= 10; ++n)
      e.design.cases.push_back({fmt::format("n{}", n), "urban", std::min(kDraws, arguments.trials.value_or(kDraws))});
    e.design.algorithms = {{"ssa", "synchronised"}, {"dssa", "asynchronous, atomic hand-over"}};
    e.design.metrics = {{"mean", "", 2}, {"max", "", 2}, {"messages", "", 0, false}};
    e.design.references = {"ssa"};
    e.design.notes = {fmt::format("{} waypoints; a modification counts for the receiver and for a sender", map->waypoints.size()),
                      "published (Fig. 7, no figures in the text): few modifications, proportional to the goals per robot"};
    e.run = [map](const Trial& trial) { return std::optional(run_trial(*map, trial)); };
    return e;
  };
}

}  // namespace

BenchInfo bench_lozenguez_modifications() {
  return {"lozenguez2015-modifications", "Lozenguez et al. 2015, Fig. 7: modifications per robot, 2 to 10 robots", declare, nullptr, nullptr};
}

}  // namespace outrider::app
