// Explore-Bench (Xu et al. 2022) by its rules: lidar of 7 m, a cell a step, to 99 %; docs/benches.md.

#include "bench.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

#include "explorer/lower_bound.hpp"
#include "explorer/mission.hpp"
#include "explorer/yaml_reader.hpp"
#include "report/metrics.hpp"
#include "world_source.hpp"

namespace outrider::app {
namespace {

using explorer::MissionResult;
using report::BenchResult;

constexpr double kRange = 7.0;  // of the lidar [m]
constexpr double kAim = 0.99;
constexpr double kStep = 0.1;  // a robot at 10 cells a second makes a step in this time [s]
const std::vector<std::string> kReferences{"reference-nearest", "reference-potential"};

struct Options {
  std::filesystem::path dir;
  std::vector<std::string> algorithms;
};

/// One map with one way to start, and the steps of the two reference methods; nothing: it never finished.
struct Setting {
  std::string map, name;
  std::vector<Cell> starts;
  std::vector<std::optional<double>> reference;
  std::string case_name() const { return map + "-" + name; }
};

/// A folder of ROS maps with a starts.yaml: `MAP: {SETTING: [[row from the top, column], ...]}` and, if known,
/// `reference_t99: MAP: {SETTING: [steps of the nearest cluster, of the potential field]}`.
class Folder {
 public:
  explicit Folder(const std::filesystem::path& dir) : dir_(dir), reader_(dir / "starts.yaml", "start cells") {
    const YAML::Node root = reader_.load();
    if (!root.IsMap()) reader_.fail(root, "expected MAP: {SETTING: [[row, column], ...]}");
    for (const auto& entry : root) {
      const std::string map = reader_.text(entry.first, "a map's name");
      const YAML::Node settings = entry.second;
      if (map == "reference_t99") continue;
      const sim::World& world = worlds_.try_emplace(map, open(map)).first->second;
      if (!settings.IsMap()) reader_.fail(settings, fmt::format("{}: expected SETTING: [[row, column], ...]", map));
      for (const auto& own : settings) {
        Setting setting{map, reader_.text(own.first, "a setting's name"), {}, {}};
        for (const auto& cell : own.second) setting.starts.push_back(start(cell, setting.case_name(), world.map));
        setting.reference = reference(root["reference_t99"], setting);
        settings_.push_back(std::move(setting));
      }
    }
  }

  const std::vector<Setting>& settings() const { return settings_; }
  const Setting& setting(const std::string& case_name) const {
    return *std::find_if(settings_.begin(), settings_.end(), [&](const auto& s) { return s.case_name() == case_name; });
  }
  const OccupancyGrid& map(const std::string& name) const { return worlds_.at(name).map; }

 private:
  sim::World open(const std::string& map) const {
    sim::World world = open_world((dir_ / (map + ".yaml")).string(), std::nullopt);
    world.map = explorer::solid_map(std::move(world.map));
    return world;
  }

  Cell start(const YAML::Node& cell, const std::string& what, const OccupancyGrid& map) const {
    if (!cell.IsSequence() || cell.size() != 2) reader_.fail(cell, what + ": expected [row from the top, column]");
    const int row = static_cast<int>(reader_.number(cell[0], what + " row", 0, map.height() - 1, ""));
    const int column = static_cast<int>(reader_.number(cell[1], what + " column", 0, map.width() - 1, ""));
    const Cell c{column, map.height() - 1 - row};
    if (map[c] != CellState::kFree)
      reader_.fail(cell, fmt::format("{}: start [{}, {}] is no free cell", what, row, column));
    return c;
  }

  std::vector<std::optional<double>> reference(const YAML::Node& all, const Setting& setting) const {
    std::vector<std::optional<double>> steps;
    const YAML::Node own = all && all[setting.map] ? all[setting.map][setting.name] : YAML::Node();
    if (!own || !own.IsSequence()) return steps;
    for (const auto& value : own)
      steps.push_back(value.Scalar() == "never" ? std::nullopt
                                                : std::optional(reader_.number(value, "reference steps", 0, 1e9, "")));
    return steps;
  }

  std::filesystem::path dir_;
  explorer::YamlReader reader_;
  std::map<std::string, sim::World> worlds_;
  std::vector<Setting> settings_;
};

/// Robots that move 10 cells a second: a step of the benchmark is 0.1 s of ours.
std::vector<RobotSpec> team_of(const Setting& setting, const GridGeometry& g) {
  std::vector<RobotSpec> team;
  for (const Cell c : setting.starts) {
    const Point p = g.center(c);
    team.push_back({.name = fmt::format("r{}", team.size() + 1),
                    .start = {p.x, p.y, 0.0},
                    .speed = g.resolution / kStep,
                    .range = kRange,
                    .radius = 0.4 * g.resolution});
  }
  return team;
}

/// Moves from cell to cell, diagonal ones too, until t [s].
double cell_moves(const std::vector<TimedPose>& trajectory, double t, double resolution) {
  double moves = 0.0;
  for (std::size_t k = 1; k < trajectory.size() && trajectory[k - 1].t < t; ++k) {
    const TimedPose &a = trajectory[k - 1], &b = trajectory[k];
    const double part = b.t <= t ? 1.0 : (t - a.t) / (b.t - a.t);
    moves += part * std::max(std::abs(b.pose.x - a.pose.x), std::abs(b.pose.y - a.pose.y)) / resolution;
  }
  return std::round(moves);
}

report::Metrics metrics_of(const MissionResult& result, const GridGeometry& g, double bound_s) {
  std::optional<double> t99;
  for (const auto& [fraction, time] : result.time_to)
    if (fraction == kAim) t99 = time;
  std::optional<double> steps, clock, ratio;
  if (t99) {
    steps = 0.0;
    for (const auto& robot : result.robots) steps = std::max(*steps, cell_moves(robot.trajectory, *t99, g.resolution));
    clock = *t99 / kStep;
    if (bound_s > 0.0) ratio = *t99 / bound_s;
  }
  double path = 0.0;
  for (const auto& robot : result.robots) path += robot.path_m;
  return {{"steps", steps},
          {"clock", clock},
          {"ratio_bound", ratio},
          {"path_m", path},
          {"explored_fraction", result.explored_fraction}};
}

std::optional<Outcome> run_trial(const Folder& folder, const Trial& trial) {
  const Setting& setting = folder.setting(trial.case_name);
  if (const auto reference = std::find(kReferences.begin(), kReferences.end(), trial.algorithm);
      reference != kReferences.end()) {
    const auto k = static_cast<std::size_t>(reference - kReferences.begin());
    if (k >= setting.reference.size()) return std::nullopt;
    return Outcome{{{"steps", setting.reference[k]}}, {}};
  }
  const OccupancyGrid& map = folder.map(setting.map);
  const std::vector<RobotSpec> team = team_of(setting, map.geometry());
  explorer::MissionSettings settings;
  settings.coordinator = trial.algorithm;
  settings.coordination.cluster_spacing = kRange;
  settings.sim.seed = trial.seed;
  settings.until = kAim;
  settings.record_events = false;
  const MissionResult result =
      explorer::run_mission(map, team, settings, [&](double, double) { return !trial.interrupted->load(); });
  return Outcome{metrics_of(result, map.geometry(), explorer::lower_bound_s(map, team, kAim, false)), {}};
}

/// Maps and settings down, algorithms across: the benchmark's own layout.
std::vector<report::Table> tables(const BenchResult& result) {
  report::Table table{"Steps to 99 %", {"map, start"}, {}, ""};
  for (const auto& a : result.design.algorithms) table.columns.push_back(a.name);
  std::string unfinished;
  for (const auto& c : result.design.cases) {
    std::vector<std::string> cells{c.name};
    for (const auto& a : result.design.algorithms) {
      const auto row = std::find_if(result.rows.begin(), result.rows.end(),
                                    [&](const auto& r) { return r.case_name == c.name && r.algorithm == a.name; });
      if (row == result.rows.end()) {
        cells.emplace_back();
        continue;
      }
      const auto steps = row->metric("steps");
      cells.push_back(steps ? fmt::format("{:.0f}", *steps) : "never");
      if (!steps && std::find(kReferences.begin(), kReferences.end(), a.name) == kReferences.end())
        unfinished += fmt::format("{}{} on {}", unfinished.empty() ? "" : ", ", a.name, c.name);
    }
    table.rows.push_back(std::move(cells));
  }
  table.note = unfinished.empty() ? "all of ours finish" : "not finished: " + unfinished;
  return {std::move(table)};
}

Experiment experiment_of(const Options& o, const BenchArguments&) {
  auto folder = std::make_shared<Folder>(o.dir);
  Experiment e;
  e.design.bench = "explore-bench";
  for (const Setting& s : folder->settings()) e.design.cases.push_back({s.case_name(), s.map, 1});
  e.design.algorithms = {{kReferences[0], "the benchmark's cost method: nearest cluster; steps from starts.yaml"},
                         {kReferences[1], "the benchmark's potential field; steps from starts.yaml"}};
  for (const auto& info : explorer::coordinators())
    if (o.algorithms.empty() || std::find(o.algorithms.begin(), o.algorithms.end(), info.name) != o.algorithms.end())
      e.design.algorithms.push_back({info.name, info.one_line});
  e.design.metrics = {{"steps", "cells", 0},
                      {"clock", "steps", 0, false},
                      {"ratio_bound", "", 2, false},
                      {"path_m", "m", 1, false},
                      {"explored_fraction", "", 4, false, false}};
  e.design.options = {{"folder", o.dir.filename().string()}};
  e.design.notes = {
      "steps: moves from cell to cell until 99 %, diagonal ones too, of the robot that made most, as the benchmark "
      "counts; clock: the same at one cell edge a step, a diagonal being longer; ratio_bound: clock over its "
      "lower bound"};
  e.run = [folder](const Trial& trial) { return run_trial(*folder, trial); };
  return e;
}

BuildExperiment declare(CLI::App& verb) {
  auto o = std::make_shared<Options>();
  std::vector<std::string> names;
  for (const auto& info : explorer::coordinators()) names.push_back(info.name);
  verb.add_option("DIR", o->dir, "folder with maps and starts.yaml")->required()->check(CLI::ExistingDirectory);
  verb.add_option("--algorithms", o->algorithms, "coordinators, comma-separated (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  return [o](const BenchArguments& arguments) { return experiment_of(*o, arguments); };
}

}  // namespace

BenchInfo bench_explore_bench() {
  return {"explore-bench", "Explore-Bench: steps to 99 % on every map of a folder, one robot or two", declare, tables,
          nullptr};
}

}  // namespace outrider::app
