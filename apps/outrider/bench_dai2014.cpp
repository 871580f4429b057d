// Dai, Yao and Zhao 2014: four unlike robots explore a sparse field from forty start placements. docs/benches.md.

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "auction/bid_options.hpp"
#include "bench.hpp"
#include "dai2014_data.hpp"
#include "dai2014_paper.hpp"
#include "decision/passability.hpp"
#include "explorer/known_map_plan.hpp"
#include "explorer/lower_bound.hpp"
#include "explorer/mission.hpp"
#include "report/metrics.hpp"
#include "report/trajectory_crossings.hpp"
#include "team_file.hpp"
#include "world/error.hpp"
#include "world_source.hpp"

namespace outrider::app {
namespace {

using explorer::MissionResult;
using explorer::MissionSettings;
using report::Json;

constexpr double kPaperCells = 100.0;  // edge of the paper's field
constexpr double kPaperAim = 0.95;     // of the environment
constexpr int kRandomMany = 400;
constexpr int kOracleTrials = 20;  // a case: its search takes seconds

struct Options {
  std::string world = "field";
  std::optional<double> resolution;
  std::vector<std::string> cases{"random", "uniform", "random-many"};
  std::vector<std::string> algorithms;
  int random_many = kRandomMany;
  int evaluations = explorer::KnownMapPlanOptions{}.evaluations;
  int oracle_trials = kOracleTrials;
  std::string bids;  // as --bids, on top of the paper-like settings
};

/// A coordinator with its parameters.
struct Variant {
  std::string name, coordinator, about;
  auction::BidParameters bids;
};

/// A rule of the paper in a setting: changes to the defaults as --bids writes them.
Variant rule(const std::string& name, const std::string& coordinator, const std::string& label,
             const std::string& changes) {
  Variant v{name, coordinator, {}, {}};
  auction::set_bid_options(v.bids, changes);
  const std::string setting = auction::bid_options_text(v.bids);
  v.about = label + (setting.empty() ? ", default setting" : ", " + setting);
  return v;
}

/// The paper's four rules twice, every other coordinator, and the oracle. docs/benches.md tells how the settings were
/// found.
std::vector<Variant> variants(const Options& o) {
  std::vector<Variant> all{
      rule("daa", "daa", "DAA-A, paper-like", o.bids),
      rule("ea", "ea", "EA-A, paper-like", o.bids),
      rule("ia", "ia", "IA-A, paper-like", "rho=0.2," + o.bids),
      rule("ta", "ta", "TA-A, paper-like", o.bids),
      rule("daa-tuned", "daa", "DAA-A, best-tuned", "weight=10"),
      rule("ea-tuned", "ea", "EA-A, best-tuned", "weight=10"),
      rule("ia-tuned", "ia", "IA-A, best-tuned", "rho=2"),
      rule("ta-tuned", "ta", "TA-A, best-tuned", "ta=unseen,rho=3"),
  };
  for (const auto& info : explorer::coordinators())
    if (!auction::bid_rule(info.name)) all.push_back({info.name, info.name, info.one_line, {}});
  all.push_back(
      {"oracle", "oracle", fmt::format("local search with the map known, {} evaluations", o.evaluations), {}});
  return all;
}

/// A world with the places where the team may start.
class Ground {
 public:
  explicit Ground(sim::World given) : world(std::move(given)), team(dai_team(world.map.geometry().resolution)) {
    world.map = explorer::solid_map(std::move(world.map));
    const auto mask = decision::passable_mask(world.map, team[0].radius);
    region_ = largest_region(mask);
    if (region_.empty())
      throw InputError(fmt::format("{}: no room for a robot of radius {:g} m", world.name, team[0].radius));
  }

  /// Cell of the paper's field -> cell of this world, moved to the nearest cell where a robot can start and go.
  Cell place(Cell paper, bool& moved) const {
    const auto& g = world.map.geometry();
    const Cell wanted{static_cast<int>((paper.x + 0.5) / kPaperCells * g.width),
                      static_cast<int>((paper.y + 0.5) / kPaperCells * g.height)};
    const auto away = [&](Cell c) { return (c.x - wanted.x) * (c.x - wanted.x) + (c.y - wanted.y) * (c.y - wanted.y); };
    const Cell nearest =
        *std::min_element(region_.begin(), region_.end(), [&](Cell a, Cell b) { return away(a) < away(b); });
    moved = nearest != wanted;
    return nearest;
  }
  Cell random_place(std::mt19937_64& random) const { return region_[random() % region_.size()]; }

  /// The team with its robots at these cells; where two would overlap, the later one goes to the nearest room.
  std::vector<RobotSpec> at(const std::array<Cell, 4>& cells) const {
    sim::World placed{world.name, world.provenance, world.map, {}, {}};
    std::vector<double> radii;
    for (std::size_t i = 0; i < 4; ++i) {
      const Point p = world.map.geometry().center(cells[i]);
      placed.starts.push_back({p.x, p.y, 0.0});
      radii.push_back(team[i].radius);
    }
    const auto starts = sim::spread_starts(placed, radii);
    std::vector<RobotSpec> result = team;
    for (std::size_t i = 0; i < 4; ++i) result[i].start = starts[i];
    return result;
  }

  sim::World world;
  std::vector<RobotSpec> team;

 private:
  static std::vector<Cell> largest_region(const Grid<std::uint8_t>& mask) {
    Grid<std::uint8_t> visited(mask.geometry());
    std::vector<Cell> largest, region;
    for (std::size_t i = 0; i < mask.size(); ++i) {
      if (!mask[i] || visited[i]) continue;
      region.assign(1, mask.geometry().cell_at(i));
      visited[i] = 1;
      for (std::size_t k = 0; k < region.size(); ++k)
        for (const Cell d : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
          const Cell n{region[k].x + d.x, region[k].y + d.y};
          if (!mask.contains(n) || !mask[n] || visited[n]) continue;
          visited[n] = 1;
          region.push_back(n);
        }
      if (region.size() > largest.size()) largest = region;
    }
    return largest;
  }

  std::vector<Cell> region_;  // where a robot can be: the largest connected part
};

const std::array<DaiPlacement, 20>& table_of(const std::string& case_name) {
  return case_name == "uniform" ? kDaiUniform : kDaiRandom;
}

std::array<Cell, 4> starts_of(const Ground& ground, const Trial& trial) {
  std::array<Cell, 4> cells;
  if (trial.case_name == "random-many") {
    std::mt19937_64 random(trial.seed);
    for (Cell& c : cells) c = ground.random_place(random);
    return cells;
  }
  bool moved = false;
  const auto& paper = table_of(trial.case_name)[static_cast<std::size_t>(trial.number - 1)].starts;
  for (std::size_t i = 0; i < 4; ++i) cells[i] = ground.place(paper[i], moved);
  return cells;
}

/// Poses up to time t, the last one interpolated.
std::vector<TimedPose> until(const std::vector<TimedPose>& trajectory, double t) {
  std::vector<TimedPose> part;
  for (const TimedPose& p : trajectory) {
    if (p.t <= t) {
      part.push_back(p);
      continue;
    }
    if (part.empty() || part.back().t == t) break;
    const TimedPose& last = part.back();
    const double s = (t - last.t) / (p.t - last.t);
    part.push_back(
        {t, {last.pose.x + s * (p.pose.x - last.pose.x), last.pose.y + s * (p.pose.y - last.pose.y), p.pose.theta}});
    break;
  }
  return part;
}

std::optional<double> reached(const MissionResult& result, double fraction) {
  for (const auto& [f, t] : result.time_to)
    if (f == fraction) return t;
  return std::nullopt;
}

/// The paper's figures, taken when 95 % was explored (at the end, if it never was).
report::Metrics metrics_of(const MissionResult& result) {
  const auto t95 = reached(result, kPaperAim);
  const double end = t95.value_or(result.mission_time_s);
  report::Metrics metrics{{"time_s", t95}, {"time99_s", reached(result, 0.99)}};
  std::vector<std::vector<TimedPose>> trajectories;
  for (const auto& robot : result.robots) trajectories.push_back(until(robot.trajectory, end));
  const auto row = std::find_if(result.timeline.begin(), result.timeline.end(),
                                [&](const auto& point) { return point.time_s >= end; });
  const auto& at_end = row == result.timeline.end() ? result.timeline.back() : *row;
  double total = 0.0;
  for (const double m2 : at_end.robot_m2) total += m2;
  for (std::size_t i = 0; i < result.robots.size(); ++i)
    metrics.emplace_back("area_share_" + result.robots[i].spec.name, total > 0.0 ? at_end.robot_m2[i] / total : 0.0);
  const report::Crossings crossings = report::trajectory_crossings(trajectories);
  for (std::size_t i = 0; i < result.robots.size(); ++i) {
    metrics.emplace_back("path_m_" + result.robots[i].spec.name, report::path_length(trajectories[i]));
    metrics.emplace_back("intersections_" + result.robots[i].spec.name, static_cast<double>(crossings.per_robot[i]));
  }
  metrics.emplace_back("intersections", static_cast<double>(crossings.count));
  std::vector<report::RobotRecord> seen;
  for (const auto& robot : result.robots) seen.push_back({robot.spec, {}, std::nullopt, robot.seen, 0.0});
  metrics.emplace_back("overlap", report::seen_areas(seen)->overlap_fraction());
  return metrics;
}

/// For the drawing of figure 3: trajectories until 95 % [m], and the world's corners.
Json drawing(const MissionResult& result, const GridGeometry& g) {
  const double end = reached(result, kPaperAim).value_or(result.mission_time_s);
  const auto centi = [](double v) { return std::round(v * 100.0) / 100.0; };
  Json trajectories = Json::object();
  for (const auto& robot : result.robots) {
    Json points = Json::array();
    for (const TimedPose& p : until(robot.trajectory, end)) points.push_back({centi(p.pose.x), centi(p.pose.y)});
    trajectories[robot.spec.name] = std::move(points);
  }
  return {
      {"trajectories", std::move(trajectories)},
      {"world_m", {g.origin.x, g.origin.y, g.origin.x + g.width * g.resolution, g.origin.y + g.height * g.resolution}}};
}

Outcome run_oracle(const Ground& ground, const std::vector<RobotSpec>& team, int evaluations, const Trial& trial) {
  const auto plan = explorer::plan_with_known_map(ground.world.map, team, {kPaperAim, evaluations, trial.seed});
  return {{{"time_s", plan.time_s}}, {}};
}

Outcome run_trial(const Ground& ground, const Variant& variant, const Options& o, const Trial& trial) {
  const std::vector<RobotSpec> team = ground.at(starts_of(ground, trial));
  if (variant.name == "oracle") return run_oracle(ground, team, o.evaluations, trial);
  MissionSettings settings;
  settings.coordinator = variant.coordinator;
  settings.coordination.bids = variant.bids;
  settings.coordination.cluster_spacing = team[2].range;  // the shortest
  settings.sim.seed = trial.seed;
  settings.until = 0.99;
  settings.record_events = false;
  const MissionResult result = explorer::run_mission(ground.world.map, team, settings,
                                                     [&](double, double) { return !trial.interrupted->load(); });
  const bool drawn = trial.case_name == "random" && trial.number == kDaiShown;
  return {metrics_of(result), drawn ? drawing(result, ground.world.map.geometry()) : Json::object()};
}

/// Time over the lower bound and over the oracle's, for the rows of one trial.
void add_ratios(const Ground& ground, std::uint64_t seed, std::vector<report::BenchRow>& rows) {
  if (rows.empty()) return;
  const Trial trial{rows[0].case_name, rows[0].trial, {}, trial_seed(seed, rows[0].case_name, rows[0].trial)};
  const double bound_s =
      explorer::lower_bound_s(ground.world.map, ground.at(starts_of(ground, trial)), kPaperAim, false);
  for (report::BenchRow& row : rows)
    if (const auto time = row.metric("time_s"); time && bound_s > 0.0)
      row.metrics.emplace_back("ratio_bound", *time / bound_s);
  add_oracle_ratio(rows);
}

std::vector<report::BenchMetric> metric_list(const std::vector<RobotSpec>& team) {
  std::vector<report::BenchMetric> metrics{
      {"time_s", "s", 1}, {"time99_s", "s", 1}, {"ratio_bound", "", 3, false}, {"ratio_oracle", "", 3, false}};
  for (const auto& robot : team) metrics.push_back({"area_share_" + robot.name, "", 3, false});
  for (const auto& robot : team) metrics.push_back({"path_m_" + robot.name, "m", 1, false, false});
  for (const auto& robot : team) metrics.push_back({"intersections_" + robot.name, "", 1, false, false});
  metrics.push_back({"intersections", "", 1});
  metrics.push_back({"overlap", "", 3});
  return metrics;
}

/// Which of the paper's start cells had to be moved, and where to.
std::vector<std::string> moved_starts(const Ground& ground, const std::vector<report::BenchCase>& cases) {
  std::vector<std::string> notes;
  for (const auto& c : cases) {
    if (c.name == "random-many") continue;
    for (int k = 0; k < c.trials; ++k)
      for (std::size_t i = 0; i < 4; ++i) {
        const Cell paper = table_of(c.name)[static_cast<std::size_t>(k)].starts[i];
        bool moved = false;
        const Cell cell = ground.place(paper, moved);
        if (moved && (i == 0 || c.name != "uniform"))
          notes.push_back(fmt::format("{} {}: start ({}, {}) is no free cell; moved to cell ({}, {})", c.name, k + 1,
                                      paper.x, paper.y, cell.x, cell.y));
      }
  }
  return notes;
}

Experiment experiment_of(const Options& o, const BenchArguments& arguments) {
  auto ground = std::make_shared<Ground>(open_world(o.world, o.resolution));
  Experiment e;
  e.design.bench = "dai2014";
  for (const std::string& name : o.cases) {
    const int all = name == "random-many" ? o.random_many : 20;
    e.design.cases.push_back({name, ground->world.name, std::min(all, arguments.trials.value_or(all))});
  }
  auto chosen = std::make_shared<std::vector<Variant>>();
  for (Variant& v : variants(o))
    if (o.algorithms.empty() || std::find(o.algorithms.begin(), o.algorithms.end(), v.name) != o.algorithms.end())
      chosen->push_back(std::move(v));
  for (const Variant& v : *chosen) e.design.algorithms.push_back({v.name, v.about});
  e.design.metrics = metric_list(ground->team);
  e.design.references = {"scout", "daa"};
  e.design.published = dai2014_published();
  e.design.options = {
      {"world", o.world}, {"bids", o.bids}, {"evaluations", o.evaluations}, {"oracle_trials", o.oracle_trials}};
  e.design.notes = moved_starts(*ground, e.design.cases);
  e.run = [ground, chosen, o](const Trial& trial) {
    const auto variant =
        std::find_if(chosen->begin(), chosen->end(), [&](const auto& v) { return v.name == trial.algorithm; });
    const bool left_out = variant->name == "oracle" && trial.number > o.oracle_trials;
    return left_out ? std::nullopt : std::optional(run_trial(*ground, *variant, o, trial));
  };
  e.complete = [ground, seed = arguments.seed](std::vector<report::BenchRow>& rows) {
    add_ratios(*ground, seed, rows);
  };
  return e;
}

BuildExperiment declare(CLI::App& verb) {
  auto o = std::make_shared<Options>();
  std::vector<std::string> names;
  for (const Variant& v : variants({})) names.push_back(v.name);
  verb.add_option("--world", o->world, "a world or map file; the start cells are scaled to its size")
      ->capture_default_str();
  verb.add_option("--resolution", o->resolution, "edge of a cell for images, .map and .txt [m]")
      ->check(number_in(1e-3, 1e3))
      ->type_name("M");
  verb.add_option("--cases", o->cases, "random, uniform (the paper's), random-many; comma-separated")
      ->delimiter(',')
      ->check(CLI::IsMember({"random", "uniform", "random-many"}))
      ->capture_default_str();
  verb.add_option("--algorithms", o->algorithms, "comma-separated (default: all)")
      ->delimiter(',')
      ->check(CLI::IsMember(names));
  verb.add_option("--random-many", o->random_many, "placements of the case random-many")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  verb.add_option("--oracle-trials", o->oracle_trials, "placements of a case for which the oracle plans")
      ->check(CLI::Range(0, 1000000))
      ->capture_default_str();
  verb.add_option("--evaluations", o->evaluations, "of changed plans in the oracle's local search")
      ->check(CLI::Range(0, 100000000))
      ->capture_default_str();
  verb.add_option("--bids", o->bids, "change the paper-like settings, as in 'outrider explore'")
      ->type_name("KEY=VALUE,...");
  return [o](const BenchArguments& arguments) { return experiment_of(*o, arguments); };
}

}  // namespace

BenchInfo bench_dai2014() {
  return {"dai2014", "Dai, Yao, Zhao 2014: auctions for four unlike robots on a sparse field", declare, dai2014_tables,
          dai2014_figures};
}

}  // namespace outrider::app
