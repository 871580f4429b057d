// How far from the best possible: coordinators beside a plan that knows the map, and beside the lower bound.

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <random>
#include <tuple>

#include "bench.hpp"
#include "explorer/known_map_plan.hpp"
#include "explorer/lower_bound.hpp"
#include "explorer/mission.hpp"
#include "sim/walls.hpp"
#include "team_file.hpp"
#include "world_source.hpp"

namespace outrider::app {
namespace {

constexpr int kTrials = 20;
constexpr double kAim = 0.95;

struct Options {
  std::vector<std::string> worlds{"field", "office", "labyrinth"}, algorithms;
  std::optional<double> resolution;
  std::vector<int> robots{4};
  std::string team = "unlike";
  int evaluations = explorer::KnownMapPlanOptions{}.evaluations;
};

/// A world and a size of the team: one case.
struct Ground {
  sim::World world;
  Grid<std::uint8_t> reachable;
  int robots = 0;
  bool alike = false;

  /// The world's usual team, or robots like its first one, together at a random place.
  std::vector<RobotSpec> team(std::uint64_t seed) const {
    TeamFile file = usual_team(world, robots);
    for (RobotSpec& robot : file.robots)
      if (alike) std::tie(robot.speed, robot.range, robot.radius) = abilities(file.robots[0]);
    sim::World placed = world;
    placed.starts = {start(seed, file.robots[0].radius)};
    return place_team(placed, std::move(file));
  }

  static std::tuple<double, double, double> abilities(const RobotSpec& robot) {
    return {robot.speed, robot.range, robot.radius};
  }

  Pose2 start(std::uint64_t seed, double radius) const {
    const sim::Walls walls(world.map, radius);
    std::mt19937_64 random(seed);
    for (;;) {
      const Cell c = world.map.geometry().cell_at(random() % world.map.size());
      const Point p = world.map.geometry().center(c);
      if (reachable[c] && walls.fits(p)) return {p.x, p.y, 0.0};
    }
  }
};
using Grounds = std::map<std::string, Ground>;

report::Metrics metrics_of(std::optional<double> time_s, double bound_s) {
  std::optional<double> ratio;
  if (time_s && bound_s > 0.0) ratio = *time_s / bound_s;
  return {{"time_s", time_s}, {"ratio_bound", ratio}};
}

Outcome run_trial(const Ground& ground, const Options& o, const Trial& trial) {
  const std::vector<RobotSpec> team = ground.team(trial.seed);
  const double bound_s = explorer::lower_bound_s(ground.world.map, team, kAim, false);
  if (trial.algorithm == "oracle") {
    const auto plan = explorer::plan_with_known_map(ground.world.map, team, {kAim, o.evaluations, trial.seed});
    return {metrics_of(plan.time_s, bound_s), {}};
  }
  explorer::MissionSettings settings;
  settings.coordinator = trial.algorithm;
  settings.coordination.cluster_spacing =
      std::min_element(team.begin(), team.end(), [](const auto& a, const auto& b) { return a.range < b.range; })->range;
  settings.sim.seed = trial.seed;
  settings.until = kAim;
  settings.record_events = false;
  const auto result = explorer::run_mission(ground.world.map, team, settings,
                                            [&](double, double) { return !trial.interrupted->load(); });
  std::optional<double> time_s;
  for (const auto& [fraction, time] : result.time_to)
    if (fraction == kAim) time_s = time;
  return {metrics_of(time_s, bound_s), {}};
}

Experiment experiment_of(const Options& o, const BenchArguments& arguments) {
  auto grounds = std::make_shared<Grounds>();
  Experiment e;
  e.design.bench = "oracle";
  for (const std::string& source : o.worlds)
    for (const int robots : o.robots) {
      sim::World world = open_world(source, o.resolution);
      world.map = explorer::solid_map(std::move(world.map));
      const std::string name = fmt::format("{}-{}", world.name, robots);
      Grid<std::uint8_t> reachable = explorer::reachable_area(world.map, place_team(world, usual_team(world, 1)));
      e.design.cases.push_back({name, world.name, arguments.trials.value_or(kTrials)});
      grounds->emplace(name, Ground{std::move(world), std::move(reachable), robots, o.team == "alike"});
    }
  for (const auto& info : explorer::coordinators())
    if (o.algorithms.empty() || std::find(o.algorithms.begin(), o.algorithms.end(), info.name) != o.algorithms.end())
      e.design.algorithms.push_back({info.name, info.one_line});
  e.design.algorithms.push_back(
      {"oracle", fmt::format("local search with the map known, {} evaluations", o.evaluations)});
  e.design.metrics = {{"time_s", "s", 1}, {"ratio_bound", "", 3, false}, {"ratio_oracle", "", 3, false}};
  e.design.references = {"scout", "daa"};
  e.design.options = {{"team", o.team}, {"evaluations", o.evaluations}};
  e.design.notes = {
      "time_s: to 95 % of the reachable area; ratio_bound, ratio_oracle: that time over the lower bound and over the "
      "oracle's plan for the same start",
      "robots start together at a random place"};
  e.run = [grounds, o](const Trial& trial) { return std::optional(run_trial(grounds->at(trial.case_name), o, trial)); };
  e.complete = add_oracle_ratio;
  return e;
}

BuildExperiment declare(CLI::App& verb) {
  auto o = std::make_shared<Options>();
  std::vector<std::string> names;
  for (const auto& info : explorer::coordinators()) names.push_back(info.name);
  verb.add_option("--worlds", o->worlds, "worlds or map files, comma-separated")->delimiter(',')->capture_default_str();
  verb.add_option("--resolution", o->resolution, "edge of a cell for images, .map and .txt [m]")
      ->check(number_in(1e-3, 1e3))
      ->type_name("M");
  verb.add_option("--robots", o->robots, "sizes of the team, comma-separated")
      ->delimiter(',')
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  verb.add_option("--team", o->team, "unlike: the world's usual team; alike: all like its first robot")
      ->check(CLI::IsMember({"unlike", "alike"}))
      ->capture_default_str();
  verb.add_option("--algorithms", o->algorithms, "coordinators, comma-separated (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  verb.add_option("--evaluations", o->evaluations, "of changed plans in the oracle's local search")
      ->check(CLI::Range(0, 100000000))
      ->capture_default_str();
  return [o](const BenchArguments& arguments) { return experiment_of(*o, arguments); };
}

}  // namespace

void add_oracle_ratio(std::vector<report::BenchRow>& trial) {
  const auto oracle =
      std::find_if(trial.begin(), trial.end(), [](const auto& row) { return row.algorithm == "oracle"; });
  const auto best = oracle == trial.end() ? std::nullopt : oracle->metric("time_s");
  if (!best || *best <= 0.0) return;
  for (report::BenchRow& row : trial)
    if (const auto time = row.metric("time_s")) row.metrics.emplace_back("ratio_oracle", *time / *best);
}

BenchInfo bench_oracle() {
  return {"oracle", "every coordinator beside a plan that knows the map, and beside the lower bound", declare, nullptr,
          nullptr};
}

}  // namespace outrider::app
