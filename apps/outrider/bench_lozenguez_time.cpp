// Lozenguez et al. 2015, section 6.1: how long policies and coordination take. docs/benches.md.

#include <fmt/format.h>

#include <ctime>

#include "bench.hpp"
#include "bench_lozenguez.hpp"
#include "explorer/allocation_run.hpp"
#include "explorer/mission_draw.hpp"

namespace outrider::app {
namespace {

constexpr double kDeviation = 0.1;
constexpr double kLongest = 4.0;  // [m] of a way where many goals need more waypoints
constexpr int kMostStochastic = 20, kPolicyTable = decision::GoMdp::kMostForTable;

struct Size {
  const char* name;
  int goals, robots, trials;
};
constexpr Size kSizes[] = {{"goals8", 8, 3, 20},   {"goals10", 10, 3, 20}, {"goals12", 12, 3, 20},
                           {"goals13", 13, 3, 20}, {"goals14", 14, 3, 20}, {"goals16", 16, 3, 10},
                           {"goals20", 20, 3, 3},  {"goals40-robots10", 40, 10, 10}, {"goals60", 60, 3, 5}};

/// CPU time of this thread [s].
double cpu_s() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct Maps {
  std::shared_ptr<const decision::TopologicalMap> certain, dense;
  decision::TopologicalMap deviating;
};

std::optional<Outcome> run_trial(const Maps& maps, const Trial& trial) {
  Size size = kSizes[0];
  for (const Size& s : kSizes)
    if (trial.case_name == s.name) size = s;
  const bool stochastic = trial.algorithm == "policy-stochastic", policy = trial.algorithm != "coordination";
  if (policy && size.goals > (stochastic ? kMostStochastic : kPolicyTable)) return std::nullopt;
  const auto& certain = size.goals > kMostStochastic ? *maps.dense : *maps.certain;
  const auto mission = explorer::draw_mission(stochastic ? maps.deviating : certain, size.goals, size.robots,
                                              explorer::Starts::kApart, trial.seed);
  const double begin = cpu_s();
  double check = 0.0;
  if (policy) {  // one robot's policy for all goals, exact, with every state that it may get into
    decision::GoMdp mdp(mission.map, mission.goals, {mission.robots[0].at});
    check = mdp.cost(mission.robots[0].at, TaskSet::first(size.goals));
  } else {  // everything from the map to the allocation, all robots' computing added up
    explorer::TeamCosts costs(mission, false);
    explorer::AllocationSettings s{.protocol = explorer::Protocol::kSsa, .seed = trial.seed};
    check = explorer::allocate(mission, costs, s).duration;
  }
  return Outcome{{{"time_s", cpu_s() - begin}}, {{"cost", check}}};
}

BuildExperiment declare(CLI::App&) {
  return [](const BenchArguments& arguments) {
    const auto certain = lozenguez_map("urban"), dense = lozenguez_map("urban", kLongest);
    const auto maps = std::make_shared<Maps>(Maps{certain, dense, with_deviation(*certain, kDeviation)});
    Experiment e;
    e.design.bench = "lozenguez2015-time";
    for (const Size& s : kSizes) e.design.cases.push_back({s.name, "urban", std::min(s.trials, arguments.trials.value_or(s.trials))});
    e.design.algorithms = {{"policy-deterministic", "exact GO-MDP of one robot for all goals"},
                           {"policy-stochastic", fmt::format("the same, every path misses with probability {:g}", kDeviation)},
                           {"coordination", "SSA from the map to the allocation, all robots' computing in one thread"}};
    e.design.metrics = {{"time_s", "s", 5, false}};
    e.design.published = {{"goals8", "policy-deterministic", "time_s", 0.5}, {"goals10", "policy-deterministic", "time_s", 1.0},
                          {"goals13", "coordination", "time_s", 22.0}, {"goals20", "coordination", "time_s", 60.0}};
    e.design.notes = {fmt::format("{} waypoints ({} for more than {} goals); CPU time of one thread; published: an ordinary laptop of 2014 a robot",
                                  certain->waypoints.size(), dense->waypoints.size(), kMostStochastic)};
    e.run = [maps](const Trial& trial) { return run_trial(*maps, trial); };
    e.serial = true;
    return e;
  };
}

}  // namespace

BenchInfo bench_lozenguez_time() {
  return {"lozenguez2015-time", "Lozenguez et al. 2015, section 6.1: time for policies and coordination", declare, nullptr, nullptr};
}

}  // namespace outrider::app
