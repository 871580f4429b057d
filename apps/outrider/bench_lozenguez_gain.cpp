// Lozenguez et al. 2015, Fig. 9 and 10: what punctual coordination saves over continuous coordination. docs/benches.md.

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "auction/optimal.hpp"
#include "bench.hpp"
#include "bench_lozenguez.hpp"
#include "explorer/allocation_run.hpp"
#include "explorer/mission_draw.hpp"
#include "report/mission_page.hpp"

namespace outrider::app {
namespace {

using explorer::AllocationSettings;
using explorer::Protocol;

constexpr int kMostGoals = 14, kDraws = 50, kRobots = 3;
constexpr int kMany = 7;  // goals from which the paper's means are about 20 %

struct Options {
  bool return_home = false;
  double noc = 0.1;
};

struct Variant {
  std::string name, about;
  Protocol protocol;
  explorer::Gains gains = explorer::Gains::kSum;
};

std::vector<Variant> variants() {
  return {{"ssa", "synchronised, from an empty allocation", Protocol::kSsa},
          {"dssa", "asynchronous, atomic hand-over", Protocol::kDssa},
          {"optimal", "the optimum of eq. 7, enumerated", Protocol::kOptimal},
          {"dssa-makespan", "dssa with a power mean of the durations as gain", Protocol::kDssa, explorer::Gains::kMakespan},
          {"scout", "least makespan: moves and swaps from seeded beginnings", Protocol::kScout},
          {"optimal-makespan", "the least makespan there is, enumerated", Protocol::kOptimal, explorer::Gains::kMakespan}};
}

struct Ground {
  Options options;
  std::shared_ptr<const decision::TopologicalMap> urban, labyrinth;
  std::vector<Variant> variants;
};

double burden_of(explorer::TeamCosts& costs, const explorer::AllocationResult& result, const AllocationSettings& s) {
  const auction::BundleProblem problem = explorer::bundle_problem(costs, s);
  auction::Allocation allocation = auction::empty_allocation(problem);
  for (std::size_t i = 0; i < result.order.size(); ++i)
    for (const int g : result.order[i]) allocation[i].insert(g);
  return auction::total_burden(problem, allocation);
}

std::optional<Outcome> run_trial(const Ground& ground, const Trial& trial) {
  const int goals = (trial.number - 1) % kMostGoals + 1;
  const bool together = trial.case_name.ends_with("together");
  const auto& map = trial.case_name.starts_with("urban") ? *ground.urban : *ground.labyrinth;
  const decision::TopoMission mission = explorer::draw_mission(
      map, goals, kRobots, together ? explorer::Starts::kTogether : explorer::Starts::kApart, trial.seed);
  explorer::TeamCosts costs(mission, ground.options.return_home);
  AllocationSettings s{.noc = ground.options.noc, .return_home = ground.options.return_home, .seed = trial.seed};
  s.protocol = Protocol::kContinuous;
  const auto continuous = explorer::allocate(mission, costs, s);
  const auto variant = std::find_if(ground.variants.begin(), ground.variants.end(), [&](const auto& v) { return v.name == trial.algorithm; });
  s.protocol = variant->protocol;
  s.gains = variant->gains;
  const auto result = explorer::allocate(mission, costs, s);
  s.gains = explorer::Gains::kSum;
  const double duration = 1.0 - result.duration / continuous.duration, movement = 1.0 - result.movement / continuous.movement;
  const double negative = duration < -1e-9 ? 1.0 : 0.0;
  Outcome outcome{{{"duration_gain", duration}, {"movement_gain", movement}, {"negative", negative}},
                  {{"goals", goals}, {"duration_s", result.duration}, {"movement_m", result.movement},
                   {"burden", burden_of(costs, result, s)}}};
  if (goals >= kMany) {
    outcome.metrics.emplace_back("duration_gain_7_14", duration);
    outcome.metrics.emplace_back("movement_gain_7_14", movement);
    outcome.metrics.emplace_back("negative_7_14", negative);
  }
  return outcome;
}

const report::BenchRow* row_of(const report::BenchResult& result, const report::BenchRow& like, const std::string& algorithm) {
  for (const auto& row : result.rows)
    if (row.case_name == like.case_name && row.trial == like.trial && row.algorithm == algorithm) return &row;
  return nullptr;
}

/// Mean excess of an algorithm's figure over the optimum's, 7 to 14 goals [%]; rows come trial by trial.
std::string excess(const report::BenchResult& result, const std::string& case_name, const std::string& algorithm,
                   const std::string& key, const std::string& optimum) {
  double sum = 0.0;
  int n = 0;
  for (const auto& row : result.rows) {
    if (row.case_name != case_name || row.algorithm != algorithm || row.extra["goals"].get<int>() < kMany) continue;
    const auto* best = row_of(result, row, optimum);
    if (best == nullptr || best->extra[key].get<double>() <= 0.0) continue;
    sum += row.extra[key].get<double>() / best->extra[key].get<double>() - 1.0;
    ++n;
  }
  return n ? fmt::format("{:.1f}", 100.0 * sum / n) : "";
}

/// A metric of all draws with so many goals [%].
std::vector<double> percents(const report::BenchResult& result, const std::string& case_name, const std::string& algorithm,
                             int goals, const std::string& metric) {
  std::vector<double> values;
  for (const auto& row : result.rows)
    if (row.case_name == case_name && row.algorithm == algorithm && row.extra["goals"].get<int>() == goals)
      values.push_back(100.0 * row.metric(metric).value_or(0.0));
  return values;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Fig. 9 and 10 as a table, by the number of goals.
report::Table by_goals(const report::BenchResult& result, const std::string& case_name, const std::string& algorithm) {
  report::Table table{fmt::format("{}: {} against continuous, in % (Fig. 9 and 10)", case_name, algorithm),
                      {"goals", "draws", "duration: mean", "best", "worst", "negative", "movement: mean", "best", "worst"}, {}, ""};
  for (int goals = 1; goals <= kMostGoals; ++goals) {
    const std::vector<double> d = percents(result, case_name, algorithm, goals, "duration_gain");
    const std::vector<double> m = percents(result, case_name, algorithm, goals, "movement_gain");
    if (d.empty()) continue;
    const auto cell = [](double x) { return fmt::format("{:.1f}", x); };
    const auto negative = std::count_if(d.begin(), d.end(), [](double x) { return x < -1e-7; });
    table.rows.push_back({std::to_string(goals), std::to_string(d.size()), cell(mean(d)), cell(*std::max_element(d.begin(), d.end())),
                          cell(*std::min_element(d.begin(), d.end())),
                          cell(100.0 * static_cast<double>(negative) / static_cast<double>(d.size())), cell(mean(m)),
                          cell(*std::max_element(m.begin(), m.end())), cell(*std::min_element(m.begin(), m.end()))});
  }
  return table;
}

std::vector<report::Table> tables(const report::BenchResult& result) {
  report::Table quality{"Above the enumerated optima, 7 to 14 goals, mean [%]", {"case", "algorithm", "value (eq. 7)", "makespan"}, {}, ""};
  std::vector<report::Table> all;
  for (const auto& c : result.design.cases) {
    all.push_back(by_goals(result, c.name, "dssa"));
    for (const auto& a : result.design.algorithms)
      quality.rows.push_back({c.name, a.name, excess(result, c.name, a.name, "burden", "optimal"),
                              excess(result, c.name, a.name, "duration_s", "optimal-makespan")});
  }
  all.push_back(std::move(quality));
  return all;
}

/// Fig. 9: mean gain of D-SSA by the number of goals.
std::string figures(const report::BenchResult& result) {
  std::string html;
  for (const auto& c : result.design.cases)
    for (const char* metric : {"duration_gain", "movement_gain"}) {
      std::vector<std::pair<double, double>> means;
      for (int goals = 1; goals <= kMostGoals; ++goals)
        if (const auto values = percents(result, c.name, "dssa", goals, metric); !values.empty())
          means.emplace_back(goals, mean(values));
      html += fmt::format("<h3>{}: {} of dssa</h3>\n{}", c.name, metric, report::curve_svg(means, "goals", "mean gain [%]"));
    }
  return html;
}

Experiment experiment_of(const Options& o, const BenchArguments& arguments) {
  auto ground = std::make_shared<Ground>(Ground{o, lozenguez_map("urban"), lozenguez_map("labyrinth"), variants()});
  Experiment e;
  e.design.bench = "lozenguez2015-gain";
  const int all = kMostGoals * kDraws;
  for (const char* name : {"urban", "labyrinth", "urban-together", "labyrinth-together"})
    e.design.cases.push_back({name, std::string(name).substr(0, std::string(name).find('-')), std::min(all, arguments.trials.value_or(all))});
  for (const Variant& v : ground->variants) e.design.algorithms.push_back({v.name, v.about});
  e.design.metrics = {{"duration_gain", "", 3}, {"movement_gain", "", 3}, {"negative", "", 3, false},
                      {"duration_gain_7_14", "", 3}, {"movement_gain_7_14", "", 3}, {"negative_7_14", "", 3, false}};
  e.design.references = {"dssa"};
  if (!o.return_home)
    for (const char* name : {"urban", "labyrinth"}) {
      e.design.published.push_back({name, "dssa", "duration_gain_7_14", 0.20});
      e.design.published.push_back({name, "dssa", "movement_gain_7_14", 0.20});
      e.design.published.push_back({name, "dssa", "negative_7_14", 1.0 / 6.0});
    }
  e.design.options = {{"return_home", o.return_home}, {"noc", o.noc}};
  e.design.notes = {fmt::format("{} and {} waypoints (urban, labyrinth); {} robots; draws in turn with 1 to {} goals",
                                ground->urban->waypoints.size(), ground->labyrinth->waypoints.size(), kRobots, kMostGoals),
                    "published: \"around 20 %\" between 7 and 14 goals, negative in less than one of six from nine goals; the "
                    "starts are not told: random ones reproduce it, common ones (-together) do not"};
  e.run = [ground](const Trial& trial) { return run_trial(*ground, trial); };
  return e;
}

BuildExperiment declare(CLI::App& verb) {
  auto o = std::make_shared<Options>();
  verb.add_flag("--return-home", o->return_home, "missions end where they began (the paper's do not)");
  verb.add_option("--noc", o->noc, "opportunity cost, of the largest cost between two waypoints")->check(number_in(0.0, 1e6))->capture_default_str();
  return [o](const BenchArguments& arguments) { return experiment_of(*o, arguments); };
}

}  // namespace

BenchInfo bench_lozenguez_gain() {
  return {"lozenguez2015-gain", "Lozenguez et al. 2015, Fig. 9, 10: punctual against continuous coordination", declare, tables, figures};
}

}  // namespace outrider::app
