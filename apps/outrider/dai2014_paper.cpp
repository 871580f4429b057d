// Dai, Yao and Zhao 2014 in their own layout: tables 1 to 7, figures 3 and 4, and what they claim.

#include "dai2014_paper.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "dai2014_data.hpp"
#include "report/bar_chart.hpp"
#include "report/path_chart.hpp"
#include "report/statistics.hpp"

namespace outrider::app {
namespace {

using report::BenchResult;
using report::Table;

struct Rule {
  const char* name;   // ours
  const char* label;  // the paper's
};
constexpr std::array<Rule, 4> kRules{{{"daa", "DAA-A"}, {"ea", "EA-A"}, {"ia", "IA-A"}, {"ta", "TA-A"}}};
constexpr std::array<const char*, 4> kRobots{"R1", "R2", "R3", "R4"};
constexpr std::array<const char*, 2> kCases{"random", "uniform"};

constexpr double kTable1[3][10] = {  // in, tl of R1 to R4 and the team, on placement 10
    {11, 321.0, 4, 439.9, 22, 294.3, 11, 199.4, 48, 1254.6},
    {2, 300.5, 44, 433.0, 58, 308.5, 28, 199.4, 132, 1241.3},
    {42, 318.7, 35, 471.5, 53, 331.5, 16, 201.4, 146, 1323.1}};
constexpr double kTable4[4][4] = {  // mean and variance, random; the same, uniform
    {155.6, 187.5, 174.5, 307.5},
    {203.4, 469.1, 202.7, 511.2},
    {213.4, 511.4, 208.1, 364.5},
    {184.3, 490.5, 268.6, 253.3}};
constexpr double kTables56[2][3][2] = {  // t, d.f. of DAA-A against EA-A, IA-A, TA-A
    {{-8.3424, 32.0973}, {-9.7691, 31.2822}, {-4.9291, 31.6741}},
    {{-4.3997, 35.7856}, {-5.7964, 37.7287}, {-17.7605, 37.6482}}};
constexpr double kTable7[2][4][4] = {  // percent of R1 to R4
    {{10.43, 77.32, 4.99, 7.26}, {8.95, 79.82, 4.83, 6.39}, {8.97, 80.02, 4.89, 6.12}, {10.63, 76.98, 5.03, 7.36}},
    {{10.17, 77.53, 4.98, 7.32}, {9.12, 79.71, 4.77, 6.40}, {8.87, 80.41, 4.65, 6.07}, {10.53, 77.21, 5.68, 6.58}}};

const report::BenchRow* row_of(const BenchResult& result, const std::string& case_name, int trial,
                               const std::string& algorithm) {
  for (const auto& row : result.rows)
    if (row.case_name == case_name && row.trial == trial && row.algorithm == algorithm) return &row;
  return nullptr;
}

std::optional<double> metric_of(const BenchResult& result, const std::string& case_name, int trial,
                                const std::string& algorithm, const std::string& metric) {
  const auto* row = row_of(result, case_name, trial, algorithm);
  return row == nullptr ? std::nullopt : row->metric(metric);
}

std::string text(std::optional<double> value, int digits) {
  return value && std::isfinite(*value) ? fmt::format("{:.{}f}", *value, digits) : "";
}

std::vector<double> values(const BenchResult& result, const std::string& case_name, const std::string& algorithm,
                           const std::string& metric) {
  std::vector<double> list;
  for (const auto& row : result.rows)
    if (row.case_name == case_name && row.algorithm == algorithm)
      if (const auto value = row.metric(metric)) list.push_back(*value);
  return list;
}

Table table1(const BenchResult& result) {
  Table table{"Table 1: intersections (in) and trajectory lengths (tl, m) on placement 10",
              {"algorithm"},
              {},
              "team in: the sum over the robots, as in the paper; each crossing counts for two robots"};
  for (const char* who : {"R1", "R2", "R3", "R4", "team"})
    for (const char* what : {"in", "tl"}) table.columns.push_back(fmt::format("{} {}", who, what));
  for (std::size_t a = 0; a < 3; ++a) {
    const auto ours = [&](const std::string& metric) {
      return metric_of(result, "random", kDaiShown, kRules[a].name, metric);
    };
    if (!ours("time_s")) continue;
    std::vector<std::string> published{fmt::format("{}, published", kRules[a].label)}, own{"ours"};
    for (std::size_t k = 0; k < 10; ++k) published.push_back(text(kTable1[a][k], k % 2 == 0 ? 0 : 1));
    double all_in = 0.0, all_tl = 0.0;
    for (const char* robot : kRobots) {
      const auto in = ours(std::string("intersections_") + robot), tl = ours(std::string("path_m_") + robot);
      own.push_back(text(in, 0));
      own.push_back(text(tl, 1));
      all_in += in.value_or(0.0);
      all_tl += tl.value_or(0.0);
    }
    own.push_back(text(all_in, 0));
    own.push_back(text(all_tl, 1));
    table.rows.push_back(std::move(published));
    table.rows.push_back(std::move(own));
  }
  return table;
}

Table placements(const BenchResult& result, const std::string& case_name, const char* title) {
  Table table{title, {"no., start cells"}, {}, "[published] ours, s to 95 %"};
  for (const Rule& rule : kRules) table.columns.emplace_back(rule.label);
  const auto& paper = case_name == "random" ? kDaiRandom : kDaiUniform;
  for (int trial = 1; trial <= 20; ++trial) {
    const DaiPlacement& p = paper[static_cast<std::size_t>(trial - 1)];
    const double published[] = {p.daa, p.ea, p.ia, p.ta};
    std::string starts = fmt::format("{}. ({},{})", trial, p.starts[0].x, p.starts[0].y);
    for (std::size_t i = 1; i < 4 && case_name == "random"; ++i)
      starts += fmt::format(" ({},{})", p.starts[i].x, p.starts[i].y);
    std::vector<std::string> row{starts};
    bool any = false;
    for (std::size_t a = 0; a < 4; ++a) {
      const auto time = metric_of(result, case_name, trial, kRules[a].name, "time_s");
      any = any || time;
      row.push_back(fmt::format("[{:g}] {}", published[a], text(time, 1)));
    }
    if (any) table.rows.push_back(std::move(row));
  }
  return table;
}

Table table4(const BenchResult& result) {
  Table table{"Table 4: mean and variance of the times", {"algorithm"}, {}, "[published] ours"};
  for (const char* c : kCases)
    for (const char* what : {"mean [s]", "variance [s²]"}) table.columns.push_back(fmt::format("{}, {}", c, what));
  for (std::size_t a = 0; a < 4; ++a) {
    std::vector<std::string> row{kRules[a].label};
    bool any = false;
    for (std::size_t c = 0; c < 2; ++c) {
      const report::Moments m = report::moments(values(result, kCases[c], kRules[a].name, "time_s"));
      any = any || m.n > 0;
      row.push_back(fmt::format("[{:g}] {}", kTable4[a][2 * c], text(m.mean, 1)));
      row.push_back(fmt::format("[{:g}] {}", kTable4[a][2 * c + 1], text(m.std * m.std, 1)));
    }
    if (any) table.rows.push_back(std::move(row));
  }
  return table;
}

Table t_tests(const BenchResult& result, std::size_t c) {
  Table table{fmt::format("Table {}: DAA-A against the others, {} case", c + 5, kCases[c]),
              {"B", "t", "d.f.", "p", "paired t", "p"},
              {},
              "[published] ours. The paper calls its tests paired; its degrees of freedom are Welch's, as here"};
  for (std::size_t b = 1; b < 4; ++b) {
    const auto v = paired_values(result, kCases[c], "time_s", "daa", kRules[b].name);
    if (v.a.size() < 2) continue;
    const report::TTest welch = report::welch_t_test(v.a, v.b), paired = report::paired_t_test(v.a, v.b);
    table.rows.push_back({kRules[b].label, fmt::format("[{:.2f}] {:.2f}", kTables56[c][b - 1][0], welch.statistic),
                          fmt::format("[{:.1f}] {:.1f}", kTables56[c][b - 1][1], welch.df),
                          fmt::format("[rejected] {:.2g}", welch.p), fmt::format("{:.2f}", paired.statistic),
                          fmt::format("{:.2g}", paired.p)});
  }
  return table;
}

Table table7(const BenchResult& result) {
  Table table{"Table 7: share of the explored area [%]", {"algorithm"}, {}, "[published] ours"};
  for (const char* c : kCases)
    for (std::size_t i = 1; i <= 4; ++i) table.columns.push_back(fmt::format("{}, A{}", c, i));
  for (std::size_t a = 0; a < 4; ++a) {
    std::vector<std::string> row{kRules[a].label};
    bool any = false;
    for (std::size_t c = 0; c < 2; ++c)
      for (std::size_t i = 0; i < 4; ++i) {
        const auto m =
            report::moments(values(result, kCases[c], kRules[a].name, std::string("area_share_") + kRobots[i]));
        any = any || m.n > 0;
        row.push_back(fmt::format("[{:.2f}] {}", kTable7[c][a][i], text(100.0 * m.mean, 2)));
      }
    if (any) table.rows.push_back(std::move(row));
  }
  return table;
}

/// One claim "a is faster than b": published and ours, for a case.
std::vector<std::string> claim(const BenchResult& result, const std::string& case_name, const std::string& a,
                               const std::string& b, const std::string& published) {
  const auto v = paired_values(result, case_name, "time_s", a, b);
  if (v.a.size() < 2) return {};
  const report::TTest t = report::paired_t_test(v.a, v.b);
  const double mean_b = report::moments(v.b).mean;
  const char* verdict = t.p >= 0.05 ? "no difference shown" : t.difference < 0.0 ? "reproduced" : "contradicted";
  return {fmt::format("{} faster than {}", a, b),
          case_name,
          fmt::format("{}", v.a.size()),
          published,
          fmt::format("{:+.1f} %", 100.0 * t.difference / mean_b),
          fmt::format("{:+.1f} to {:+.1f} %", 100.0 * t.ci95.lo / mean_b, 100.0 * t.ci95.hi / mean_b),
          fmt::format("{:.2g}", t.p),
          verdict};
}

Table claims(const BenchResult& result) {
  Table table{"What of it is reproduced",
              {"claim", "case", "n", "published", "ours", "95 %", "paired p", "verdict"},
              {},
              "difference of the mean times; daa, ea, ia, ta: the paper-like settings, -tuned: the best of each rule"};
  const std::pair<const char*, const char*> pairs[] = {{"daa", "ea"},
                                                       {"daa", "ia"},
                                                       {"daa", "ta"},
                                                       {"daa-tuned", "ea-tuned"},
                                                       {"daa-tuned", "ia-tuned"},
                                                       {"daa-tuned", "ta-tuned"}};
  for (const auto& c : result.design.cases)
    for (std::size_t k = 0; k < std::size(pairs); ++k) {
      std::string published;
      for (std::size_t p = 0; p < 2 && k < 3; ++p)
        if (c.name == kCases[p])
          published =
              fmt::format("{:+.1f} %", 100.0 * (kTable4[0][2 * p] - kTable4[k + 1][2 * p]) / kTable4[k + 1][2 * p]);
      if (auto row = claim(result, c.name, pairs[k].first, pairs[k].second, published); !row.empty())
        table.rows.push_back(std::move(row));
    }
  return table;
}

std::string trajectories(const BenchResult& result) {
  std::string html = "<figure>\n<div class=\"row\">\n";
  bool any = false;
  for (const Rule& rule : kRules) {
    const auto* row = row_of(result, "random", kDaiShown, rule.name);
    if (row == nullptr || !row->extra.contains("trajectories")) continue;
    std::vector<report::ChartPath> paths;
    for (const auto& [name, points] : row->extra["trajectories"].items()) {
      report::ChartPath path{name, {}};
      for (const auto& p : points) path.points.push_back({p[0].get<double>(), p[1].get<double>()});
      paths.push_back(std::move(path));
    }
    const auto corners = row->extra["world_m"].get<std::vector<double>>();
    html += path_chart(fmt::format("{}, {} s", rule.label, text(row->metric("time_s"), 1)), {corners[0], corners[1]},
                       {corners[2], corners[3]}, paths);
    any = true;
  }
  return any ? html +
                   "</div>\n<figcaption>The paper's figure 3: trajectories until 95 % are explored, placement 10 of "
                   "table 2."
                   "</figcaption>\n</figure>\n"
             : std::string();
}

}  // namespace

std::vector<report::PublishedFigure> dai2014_published() {
  std::vector<report::PublishedFigure> figures;
  for (std::size_t c = 0; c < 2; ++c)
    for (std::size_t a = 0; a < 4; ++a) {
      figures.push_back({kCases[c], kRules[a].name, "time_s", kTable4[a][2 * c]});
      for (std::size_t i = 0; i < 4; ++i)
        figures.push_back(
            {kCases[c], kRules[a].name, std::string("area_share_") + kRobots[i], kTable7[c][a][i] / 100.0});
    }
  return figures;
}

std::vector<Table> dai2014_tables(const BenchResult& result) {
  std::vector<Table> tables;
  for (Table table : {table1(result), placements(result, "random", "Table 2: exploration times, random initialization"),
                      placements(result, "uniform", "Table 3: exploration times, uniformly random initialization"),
                      table4(result), t_tests(result, 0), t_tests(result, 1), table7(result), claims(result)})
    if (!table.rows.empty()) tables.push_back(std::move(table));
  return tables;
}

std::string dai2014_figures(const BenchResult& result) {
  std::string html = "<section>\n<h2>The paper's figures</h2>\n" + trajectories(result);
  for (const auto& c : result.design.cases) {
    std::vector<report::Bar> bars;
    for (const auto& a : result.design.algorithms) {
      const report::Moments m = report::moments(values(result, c.name, a.name, "time_s"));
      if (m.n > 0) bars.push_back({a.name, m.mean, report::mean_interval(m)});
    }
    html += "<figure>\n" + bar_chart("time to 95 % [s]", bars) +
            fmt::format(
                "<figcaption>The paper's figure 4 for the case {}: means of {} placements with 95 % intervals."
                "</figcaption>\n</figure>\n",
                c.name, c.trials);
  }
  return html + "</section>\n";
}

}  // namespace outrider::app
