// Matignon, Jeanpierre and Mouaddib 2012, figure 5: a team explores an office while its radio fails. docs/benches.md.

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <random>

#include "bench.hpp"
#include "explorer/mission.hpp"
#include "report/bar_chart.hpp"
#include "report/html.hpp"
#include "sim/walls.hpp"
#include "world/error.hpp"
#include "world_source.hpp"

namespace outrider::app {
namespace {

using explorer::MissionResult;
using explorer::MissionSettings;
using explorer::MissionStatus;
using report::BenchResult;

constexpr int kTrials = 100;
constexpr int kBreaks = 5;
constexpr int kTeam = 4;          // where a world has no usual team
constexpr double kApart = 1.1;    // [m] between start poses at least: robots that stand at home do not interact
constexpr double kScatter = 0.4;  // [m] a trial moves each start pose by up to this much along either axis

struct Options {
  std::vector<std::string> worlds{"office1", "office2"};
  std::optional<double> resolution, break_s;
  std::optional<int> robots;
  std::vector<std::string> algorithms;
  double speed = 0.3, range = 4.0, radius = 0.2;
  decision::DvfReading reading;
};

/// Radio and coordinator of one of the paper's conditions.
struct Condition {
  std::string name, coordinator, about;
  enum class Radio { kNone, kIdeal, kFailing } radio;
};

std::vector<Condition> conditions() {
  using Radio = Condition::Radio;
  std::vector<Condition> all{
      {"none", "independent", "no communication, eq. 1", Radio::kNone},
      {"permanent", "dvf", "permanent communication, eq. 2", Radio::kIdeal},
      {"breaks+independent", "dvf-reactive", "breaks, during which robots ignore each other, eq. 6", Radio::kFailing},
      {"breaks+dvf", "dvf", "breaks, new DVF: Algorithm 1, eq. 3 and 7", Radio::kFailing}};
  for (const auto& info : explorer::coordinators())
    if (info.name == "scout") all.push_back({"breaks+scout", "scout", "breaks, ours: " + info.one_line, Radio::kFailing});
  return all;
}

/// A world with what a trial needs to begin in it.
struct Ground {
  Ground(sim::World w, const Options& o) : world(std::move(w)) {
    world.map = explorer::solid_map(std::move(world.map));
    const int usual = world.team.empty() ? kTeam : static_cast<int>(world.team.size());
    robots = static_cast<std::size_t>(o.robots.value_or(usual));
    const bool given = world.starts.size() >= robots;
    const std::vector<double> radii(robots, given ? o.radius : std::max(o.radius, kApart / 2.0));
    starts = sim::spread_starts(world, radii);
    walls.emplace(world.map, o.radius);
    break_s = o.break_s.value_or(world.name == "office1" ? 25.0 : 40.0);
  }

  /// The start poses in random order, each moved a little at random where there is room: no two trials are alike.
  std::vector<Pose2> draw_starts(std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    const auto unit = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
    std::vector<Pose2> poses = starts;
    for (std::size_t i = poses.size(); i > 1; --i) std::swap(poses[i - 1], poses[random() % i]);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Pose2 moved{poses[i].x + kScatter * (2.0 * unit() - 1.0), poses[i].y + kScatter * (2.0 * unit() - 1.0),
                        poses[i].theta};
      const bool apart = std::all_of(poses.begin(), poses.end(), [&](const Pose2& other) {
        return &other == &poses[i] || distance(other.position(), moved.position()) > std::max(kApart, 2.0 * walls->radius());
      });
      // Planning starts from the centre of a cell, which must be a place for a robot too.
      const Point center = world.map.geometry().center(world.map.geometry().cell_of(moved.position()));
      if (apart && walls->fits(moved.position()) && walls->fits(center)) poses[i] = moved;
    }
    return poses;
  }

  sim::World world;
  std::size_t robots = 0;
  std::vector<Pose2> starts;
  std::optional<sim::Walls> walls;
  double break_s = 0.0;
};

std::vector<RobotSpec> draw_team(const Ground& ground, const Options& o, std::uint64_t seed) {
  std::vector<RobotSpec> team;
  for (const Pose2& start : ground.draw_starts(seed))
    team.push_back({.name = fmt::format("r{}", team.size() + 1), .start = start, .speed = o.speed, .range = o.range,
                    .radius = o.radius});
  return team;
}

report::Metrics metrics_of(const MissionResult& r) {
  const bool finished = r.status == MissionStatus::kExplored || r.status == MissionStatus::kUnreachableLeft;
  const auto when_finished = [&](double v) { return finished ? std::optional(v) : std::nullopt; };
  const auto count = [](std::uint64_t n) { return static_cast<double>(n); };
  return {{"mission_time_s", when_finished(r.mission_time_s)},
          {"exploration_time_s", when_finished(r.time_s)},
          {"interaction_s", r.interaction_s},
          {"interactions", count(r.interactions)},
          {"interaction_in_breaks_s", r.interaction_in_breaks_s},
          {"interactions_in_breaks", count(r.interactions_in_breaks)},
          {"interaction_outside_s", r.interaction_s - r.interaction_in_breaks_s},
          {"interactions_outside", count(r.interactions - r.interactions_in_breaks)},
          {"explored_fraction", r.explored_fraction}};
}

Outcome run_trial(const Ground& ground, const Condition& condition, const Options& o, const Trial& trial) {
  MissionSettings settings;
  settings.coordinator = condition.coordinator;
  settings.coordination.dvf = o.reading;
  settings.coordination.cluster_spacing = o.range;
  settings.explorer.return_home = true;
  settings.sim.seed = trial.seed;
  settings.radio.seed = trial.seed;
  settings.radio.none = condition.radio == Condition::Radio::kNone;
  if (condition.radio == Condition::Radio::kFailing)  // they take half of the time into which they fall
    settings.radio.random_breaks = {{kBreaks, ground.break_s, 2.0 * kBreaks * ground.break_s}};
  settings.record_events = false;
  const MissionResult result = explorer::run_mission(ground.world.map, draw_team(ground, o, trial.seed), settings,
                                                     [&](double, double) { return !trial.interrupted->load(); });
  return {metrics_of(result), {}};
}

Experiment experiment_of(const Options& o, const BenchArguments& arguments) {
  auto grounds = std::make_shared<std::map<std::string, Ground>>();
  Experiment e;
  e.design.bench = "matignon2012";
  for (const std::string& source : o.worlds) {
    sim::World world = open_world(source, o.resolution);
    const std::string name = world.name;
    const Ground& ground = grounds->try_emplace(name, std::move(world), o).first->second;
    e.design.cases.push_back({name, source, arguments.trials.value_or(kTrials)});
    e.design.notes.push_back(fmt::format("{}: {} robots of {:g} m/s, range {:g} m; {} breaks of {:g} s within {:g} s", name,
                                         ground.robots, o.speed, o.range, kBreaks, ground.break_s,
                                         2.0 * kBreaks * ground.break_s));
  }
  e.design.notes.push_back("an interaction is a time in which two robots are closer than 1 m; interaction_s counts "
                           "robot-seconds");
  auto chosen = std::make_shared<std::vector<Condition>>();
  for (Condition& c : conditions())
    if (o.algorithms.empty() || std::find(o.algorithms.begin(), o.algorithms.end(), c.name) != o.algorithms.end())
      chosen->push_back(std::move(c));
  for (const Condition& c : *chosen) e.design.algorithms.push_back({c.name, c.about});
  e.design.metrics = {{"mission_time_s", "s", 1},       {"exploration_time_s", "s", 1},
                      {"interaction_s", "s", 1},        {"interactions", "", 1},
                      {"interaction_in_breaks_s", "s", 1}, {"interactions_in_breaks", "", 1},
                      {"interaction_outside_s", "s", 1, false, false}, {"interactions_outside", "", 1, false, false},
                      {"explored_fraction", "", 4, false, false}};
  e.design.references = {"breaks+dvf"};
  e.design.options = {{"worlds", o.worlds}, {"speed", o.speed}, {"range", o.range}, {"radius", o.radius},
                      {"dvf_gamma", o.reading.gamma}, {"dvf_reach", o.reading.reach}, {"dvf_kappa", o.reading.kappa},
                      {"dvf_intentions", o.reading.intentions}};
  e.run = [grounds, chosen, o](const Trial& trial) {
    const auto condition = std::find_if(chosen->begin(), chosen->end(), [&](const auto& c) { return c.name == trial.algorithm; });
    return std::optional(run_trial(grounds->at(trial.case_name), *condition, o, trial));
  };
  return e;
}

BuildExperiment declare(CLI::App& verb) {
  auto o = std::make_shared<Options>();
  std::vector<std::string> names;
  for (const Condition& c : conditions()) names.push_back(c.name);
  verb.add_option("--world", o->worlds, "worlds or map files; comma-separated")->delimiter(',')->capture_default_str();
  verb.add_option("--resolution", o->resolution, "edge of a cell for images, .map and .txt [m]")
      ->check(number_in(1e-3, 1e3))->type_name("M");
  verb.add_option("--robots", o->robots, "size of the team (default: the world's usual team, or 4)")
      ->check(CLI::Range(1, 100))->type_name("N");
  verb.add_option("--algorithms", o->algorithms, "conditions, comma-separated (default: all)")
      ->delimiter(',')->check(CLI::IsMember(names));
  verb.add_option("--speed", o->speed, "of every robot [m/s]")->check(number_in(0.01, 100.0))->capture_default_str();
  verb.add_option("--range", o->range, "of every robot's sensor [m]")->check(number_in(0.1, 1000.0))->capture_default_str();
  verb.add_option("--radius", o->radius, "of every robot [m]")->check(number_in(0.01, 10.0))->capture_default_str();
  verb.add_option("--break-time", o->break_s, "length of a break [s] (default: 25 in office1, else 40)")
      ->check(number_in(0.1, 1e5))->type_name("S");
  verb.add_option("--dvf-gamma", o->reading.gamma, "discount per metre")->check(number_in(0.01, 0.999))->capture_default_str();
  verb.add_option("--dvf-reach", o->reading.reach, "l of Pr(s'|s_j) = exp(-d/l) [m]")
      ->check(number_in(0.01, 1e3))->capture_default_str();
  verb.add_option("--dvf-kappa", o->reading.kappa, "weight of the others")->check(number_in(0.0, 1e3))->capture_default_str();
  verb.add_flag("--dvf-intentions", o->reading.intentions, "the others' waves start from their goals too");
  return [o](const BenchArguments& arguments) { return experiment_of(*o, arguments); };
}

// What the paper shows: figure 5, and how its conditions compare over all cases.

const report::BenchSummary* find(const std::vector<report::BenchSummary>& all, const std::string& case_name,
                                 const std::string& algorithm, const std::string& metric) {
  for (const auto& s : all)
    if (s.case_name == case_name && s.algorithm == algorithm && s.metric == metric) return &s;
  return nullptr;
}

/// A row "a against b" over the pairs of all cases.
std::vector<std::string> pooled_row(const BenchResult& result, const std::string& metric, const std::string& a,
                                    const std::string& b) {
  report::PairedValues all;
  for (const auto& c : result.design.cases) {
    const report::PairedValues v = paired_values(result, c.name, metric, a, b);
    all.a.insert(all.a.end(), v.a.begin(), v.a.end());
    all.b.insert(all.b.end(), v.b.begin(), v.b.end());
  }
  if (all.a.size() < 2) return {};
  const double mean_a = report::moments(all.a).mean, mean_b = report::moments(all.b).mean;
  const report::TTest t = report::paired_t_test(all.a, all.b);
  return {fmt::format("{}: {} against {}", metric, a, b), fmt::format("{}", all.a.size()), fmt::format("{:.1f}", mean_a),
          fmt::format("{:.1f}", mean_b), fmt::format("{:.3f}", mean_a / mean_b),
          fmt::format("{:+.1f} to {:+.1f}", t.ci95.lo, t.ci95.hi), fmt::format("{:.2f}", t.statistic),
          fmt::format("{:.2g}", t.p)};
}

std::vector<report::Table> tables(const BenchResult& result) {
  report::Table table{"matignon2012: all cases together",
                      {"a against b", "n", "mean a", "mean b", "a / b", "a - b, 95 %", "paired t", "p"}, {}, ""};
  const std::vector<std::pair<std::string, std::string>> pairs{
      {"none", "permanent"}, {"none", "breaks+independent"}, {"none", "breaks+dvf"},
      {"breaks+dvf", "breaks+independent"}, {"breaks+dvf", "permanent"}, {"breaks+scout", "breaks+dvf"}};
  for (const char* metric : {"mission_time_s", "exploration_time_s", "interaction_s", "interactions"})
    for (const auto& [a, b] : pairs)
      if (auto row = pooled_row(result, metric, a, b); !row.empty()) table.rows.push_back(std::move(row));
  if (table.rows.empty()) return {};
  return {table};
}

std::string figures(const BenchResult& result) {
  const auto summary = summarise(result);
  std::string html = "<section>\n<h2>Time and interactions (the paper's figure 5)</h2>\n";
  for (const auto& c : result.design.cases) {
    html += "<figure>\n<div class=\"row\">\n";
    for (const auto& [metric, title] : {std::pair("mission_time_s", "mission time [s]"),
                                        std::pair("interaction_s", "time in local interactions [robot-seconds]")}) {
      std::vector<report::Bar> bars;
      for (const auto& a : result.design.algorithms)
        if (const auto* s = find(summary, c.name, a.name, metric)) bars.push_back({a.name, s->mean, {s->lo, s->hi}});
      html += bar_chart(title, bars);
    }
    html += fmt::format("</div>\n<figcaption>{}: means of up to {} trials with 95 % intervals.</figcaption>\n</figure>\n",
                        report::escape_html(c.name), c.trials);
  }
  return html + "</section>\n";
}

}  // namespace

BenchInfo bench_matignon2012() {
  return {"matignon2012", "Matignon et al. 2012: exploring an office while the radio fails", declare, tables, figures};
}

}  // namespace outrider::app
