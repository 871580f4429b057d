// How a bench result is shown: tables, CSV, the page.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/assets.hpp"
#include "report/bench_result.hpp"
#include "report/html.hpp"
#include "report/statistics.hpp"

namespace outrider::report {
namespace {

std::string p_text(double p) {
  return std::isnan(p) ? "" : p < 1e-4 ? fmt::format("{:.0e}", p) : fmt::format("{:.4f}", p);
}

const BenchSummary* find(const std::vector<BenchSummary>& all, const std::string& case_name,
                         const std::string& algorithm, const std::string& metric) {
  for (const auto& s : all)
    if (s.case_name == case_name && s.algorithm == algorithm && s.metric == metric) return &s;
  return nullptr;
}

std::string mean_text(const BenchSummary& s, int digits) {
  std::string text = s.n == 0 ? "never" : fmt::format("{:.{}f}", s.mean, digits);
  if (s.n > 1) text += fmt::format(" ± {:.{}f}", s.std, digits);
  if (s.n > 0 && s.missing > 0) text += fmt::format(" ({} never)", s.missing);
  if (s.published) text += fmt::format(" [{:g}]", *s.published);
  return text;
}

Table case_table(const BenchResult& result, const std::vector<BenchSummary>& summary, const BenchCase& c) {
  Table table{fmt::format("{}: {}, {} trial{}", result.design.bench, c.name, c.trials, c.trials == 1 ? "" : "s"),
              {"algorithm"}, {}, ""};
  std::vector<const BenchMetric*> shown;
  for (const auto& m : result.design.metrics)
    if (m.shown && std::any_of(summary.begin(), summary.end(), [&](const BenchSummary& s) {
          return s.case_name == c.name && s.metric == m.name;
        })) {
      shown.push_back(&m);
      table.columns.push_back(m.unit.empty() ? m.name : fmt::format("{} [{}]", m.name, m.unit));
    }
  bool any_published = false;
  for (const auto& a : result.design.algorithms) {
    std::vector<std::string> row{a.name};
    bool any = false;
    for (const BenchMetric* m : shown) {
      const BenchSummary* s = find(summary, c.name, a.name, m->name);
      row.push_back(s != nullptr ? mean_text(*s, m->digits) : "");
      any = any || s != nullptr;
      any_published = any_published || (s != nullptr && s->published);
    }
    if (any) table.rows.push_back(std::move(row));
  }
  table.note = std::string("mean ± standard deviation") + (any_published ? "; published mean in brackets" : "");
  return table;
}

Table tests_table(const BenchResult& result, const BenchCase& c) {
  Table table{fmt::format("{}: {}, a against b", result.design.bench, c.name),
              {"metric", "a", "b", "n", "a - b", "95 % interval", "paired t", "p", "Welch t", "df", "p"}, {}, ""};
  for (const auto& m : result.design.metrics)
    for (const auto& a : result.design.references)
      for (const auto& b : result.design.algorithms) {
        if (!m.tested || !m.shown || a == b.name) continue;
        const PairedValues v = paired_values(result, c.name, m.name, a, b.name);
        if (v.a.size() < 2) continue;
        const TTest paired = paired_t_test(v.a, v.b), welch = welch_t_test(v.a, v.b);
        table.rows.push_back({m.name, a, b.name, fmt::format("{}", v.a.size()),
                              fmt::format("{:+.{}f}", paired.difference, m.digits),
                              fmt::format("{:+.{}f} to {:+.{}f}", paired.ci95.lo, m.digits, paired.ci95.hi, m.digits),
                              fmt::format("{:.2f}", paired.statistic), p_text(paired.p),
                              fmt::format("{:.2f}", welch.statistic), fmt::format("{:.1f}", welch.df),
                              p_text(welch.p)});
      }
  return table;
}

std::string settings_html(const BenchResult& result) {
  std::string rows;
  for (const auto& a : result.design.algorithms)
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escape_html(a.name), escape_html(a.about));
  return rows;
}

}  // namespace

std::vector<Table> bench_tables(const BenchResult& result) {
  const std::vector<BenchSummary> summary = summarise(result);
  std::vector<Table> tables;
  for (const auto& c : result.design.cases) {
    if (Table table = case_table(result, summary, c); !table.rows.empty()) tables.push_back(std::move(table));
    if (Table table = tests_table(result, c); !table.rows.empty()) tables.push_back(std::move(table));
  }
  return tables;
}

std::string bench_csv(const BenchResult& result) {
  std::string csv = "case,map,trial,algorithm";
  for (const auto& m : result.design.metrics) csv += ',' + csv_field(m.name);
  csv += '\n';
  for (const BenchRow& row : result.rows) {
    std::string map;
    for (const auto& c : result.design.cases)
      if (c.name == row.case_name) map = c.map;
    csv += fmt::format("{},{},{},{}", csv_field(row.case_name), csv_field(map), row.trial, csv_field(row.algorithm));
    for (const auto& m : result.design.metrics) {
      const auto value = row.metric(m.name);
      csv += value ? fmt::format(",{}", *value) : std::string(",");
    }
    csv += '\n';
  }
  return csv;
}

std::string bench_html(const BenchResult& result, std::span<const Table> tables, const std::string& figures) {
  std::string body;
  for (const Table& table : tables) body += table_html(table);
  std::string notes;
  for (const std::string& note : result.design.notes) notes += fmt::format("<li>{}</li>\n", escape_html(note));
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{0}</title>\n"
      "<style>\n{1}\nfigure.table {{overflow-x: auto}} figure.table td, figure.table thead th {{text-align: right; "
      "white-space: nowrap}} figure.table th:first-child {{text-align: left}} "
      "figure.table {{counter-increment: none}} figure.table figcaption::before {{content: none}}\n"
      "</style>\n</head>\n<body>\n<main>\n<h1>{0}</h1>\n<p>Seed {2}{3}.</p>\n{4}\n{5}\n<section>\n"
      "<h2>Settings</h2>\n<table class=\"list\"><tbody>\n{6}</tbody></table>\n<ul>\n{7}</ul>\n</section>\n</main>\n"
      "</body>\n</html>\n",
      escape_html(result.design.bench), style_sheet(), result.seed, result.interrupted ? ", interrupted" : "", figures,
      body, settings_html(result), notes);
}

}  // namespace outrider::report
