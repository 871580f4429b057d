#include "report/bench_result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "report/statistics.hpp"
#include "world/error.hpp"

namespace outrider::report {
namespace {

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(); }

const BenchCase& case_of(const BenchDesign& design, const std::string& name) {
  return *std::find_if(design.cases.begin(), design.cases.end(), [&](const BenchCase& c) { return c.name == name; });
}

std::optional<double> published(const BenchDesign& design, const std::string& case_name, const std::string& algorithm,
                                const std::string& metric) {
  for (const PublishedFigure& p : design.published)
    if (p.case_name == case_name && p.algorithm == algorithm && p.metric == metric) return p.value;
  return std::nullopt;
}

Json design_json(const BenchDesign& d) {
  Json cases = Json::array(), algorithms = Json::array(), metrics = Json::array(), figures = Json::array();
  for (const auto& c : d.cases) cases.push_back({{"name", c.name}, {"map", c.map}, {"trials", c.trials}});
  for (const auto& a : d.algorithms) algorithms.push_back({{"name", a.name}, {"about", a.about}});
  for (const auto& m : d.metrics)
    metrics.push_back({{"name", m.name}, {"unit", m.unit}, {"digits", m.digits}, {"tested", m.tested}, {"shown", m.shown}});
  for (const auto& p : d.published)
    figures.push_back({{"case", p.case_name}, {"algorithm", p.algorithm}, {"metric", p.metric}, {"value", p.value}});
  return {{"cases", cases}, {"algorithms", algorithms}, {"metrics", metrics}, {"references", d.references},
          {"published", figures}};
}

BenchDesign parse_design(const Json& json) {
  const Json& d = json.at("design");
  BenchDesign design;
  design.bench = json.at("bench");
  design.options = json.at("options");
  design.notes = json.at("notes").get<std::vector<std::string>>();
  for (const Json& c : d.at("cases")) design.cases.push_back({c.at("name"), c.at("map"), c.at("trials")});
  for (const Json& a : d.at("algorithms")) design.algorithms.push_back({a.at("name"), a.at("about")});
  for (const Json& m : d.at("metrics"))
    design.metrics.push_back({m.at("name"), m.at("unit"), m.at("digits"), m.at("tested"), m.at("shown")});
  design.references = d.at("references").get<std::vector<std::string>>();
  for (const Json& p : d.at("published"))
    design.published.push_back({p.at("case"), p.at("algorithm"), p.at("metric"), p.at("value")});
  return design;
}

Json row_json(const BenchDesign& design, const BenchRow& row) {
  Json json{{"case", row.case_name}, {"map", case_of(design, row.case_name).map}, {"trial", row.trial},
            {"algorithm", row.algorithm}};
  for (const auto& [name, value] : row.metrics) json[name] = value ? number(*value) : Json();
  for (const auto& [key, value] : row.extra.items()) json[key] = value;
  return json;
}

BenchRow parse_row(const BenchDesign& design, const Json& json) {
  BenchRow row{json.at("case"), json.at("trial"), json.at("algorithm"), {}, Json::object()};
  for (const auto& [key, value] : json.items()) {
    if (key == "case" || key == "map" || key == "trial" || key == "algorithm") continue;
    if (design.metric(key) == nullptr) row.extra[key] = value;
    else row.metrics.emplace_back(key, value.is_null() ? std::nullopt : std::optional(value.get<double>()));
  }
  return row;
}

struct Comparison {
  std::string case_name, metric, a, b;
};

/// Every reference against every other algorithm, each pair once, for the tested metrics.
std::vector<Comparison> comparisons(const BenchDesign& design) {
  std::vector<Comparison> list;
  for (const auto& c : design.cases)
    for (const auto& m : design.metrics) {
      if (!m.tested) continue;
      std::set<std::pair<std::string, std::string>> done;
      for (const auto& a : design.references)
        for (const auto& b : design.algorithms)
          if (a != b.name && !done.contains({b.name, a}) && done.insert({a, b.name}).second)
            list.push_back({c.name, m.name, a, b.name});
    }
  return list;
}

Json test_json(const Comparison& c, const char* test, const TTest& t, std::size_t n) {
  return {{"case", c.case_name}, {"metric", c.metric}, {"a", c.a}, {"b", c.b}, {"test", test}, {"n", n},
          {"difference", number(t.difference)}, {"ci95", {number(t.ci95.lo), number(t.ci95.hi)}},
          {"statistic", number(t.statistic)}, {"df", number(t.df)}, {"p", number(t.p)}};
}

Json tests_json(const BenchResult& result) {
  Json tests = Json::array();
  for (const Comparison& c : comparisons(result.design)) {
    const PairedValues v = paired_values(result, c.case_name, c.metric, c.a, c.b);
    if (v.a.size() < 2) continue;
    tests.push_back(test_json(c, "paired", paired_t_test(v.a, v.b), v.a.size()));
    tests.push_back(test_json(c, "welch", welch_t_test(v.a, v.b), v.a.size()));
  }
  return tests;
}

std::size_t position(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
}

/// Puts rows into the order of the design.
void sort_rows(const BenchDesign& design, std::vector<BenchRow>& rows) {
  std::vector<std::string> cases, algorithms;
  for (const auto& c : design.cases) cases.push_back(c.name);
  for (const auto& a : design.algorithms) algorithms.push_back(a.name);
  const auto key = [&](const BenchRow& r) {
    return std::tuple(position(cases, r.case_name), r.trial, position(algorithms, r.algorithm));
  };
  std::stable_sort(rows.begin(), rows.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
}

}  // namespace

const BenchMetric* BenchDesign::metric(const std::string& name) const {
  const auto found = std::find_if(metrics.begin(), metrics.end(), [&](const BenchMetric& m) { return m.name == name; });
  return found == metrics.end() ? nullptr : &*found;
}

std::optional<double> BenchRow::metric(const std::string& name) const {
  for (const auto& [known, value] : metrics)
    if (known == name) return value;
  return std::nullopt;
}

std::vector<BenchSummary> summarise(const BenchResult& result) {
  const BenchDesign& design = result.design;
  struct Values {
    std::vector<double> reached;
    std::size_t missing = 0;
  };
  std::map<std::tuple<std::string, std::string, std::string>, Values> values;
  for (const BenchRow& row : result.rows)
    for (const auto& [name, value] : row.metrics) {
      Values& v = values[{row.case_name, row.algorithm, name}];
      if (value) v.reached.push_back(*value);
      else ++v.missing;
    }
  std::vector<BenchSummary> summaries;
  for (const auto& c : design.cases)
    for (const auto& a : design.algorithms)
      for (const auto& m : design.metrics) {
        const auto found = values.find({c.name, a.name, m.name});
        if (found == values.end()) continue;
        const Moments moment = moments(found->second.reached);
        const Interval ci = mean_interval(moment);
        summaries.push_back({c.name, a.name, m.name, moment.n, found->second.missing, moment.mean, moment.std, ci.lo,
                             ci.hi, published(design, c.name, a.name, m.name)});
      }
  return summaries;
}

PairedValues paired_values(const BenchResult& result, const std::string& case_name, const std::string& metric,
                           const std::string& a, const std::string& b) {
  std::map<int, std::pair<std::optional<double>, std::optional<double>>> by_trial;
  for (const BenchRow& row : result.rows) {
    if (row.case_name != case_name) continue;
    if (row.algorithm == a) by_trial[row.trial].first = row.metric(metric);
    if (row.algorithm == b) by_trial[row.trial].second = row.metric(metric);
  }
  PairedValues values;
  for (const auto& [trial, pair] : by_trial)
    if (pair.first && pair.second) {
      values.a.push_back(*pair.first);
      values.b.push_back(*pair.second);
    }
  return values;
}

Json bench_json(const BenchResult& result) {
  Json json{{"schema", 1}, {"bench", result.design.bench}, {"seed", result.seed}, {"options", result.design.options}};
  if (!result.shard.empty()) json["shard"] = result.shard;
  if (result.interrupted) json["interrupted"] = true;
  Json rows = Json::array(), summary = Json::array();
  for (const BenchRow& row : result.rows) rows.push_back(row_json(result.design, row));
  for (const BenchSummary& s : summarise(result))
    summary.push_back({{"case", s.case_name}, {"algorithm", s.algorithm}, {"metric", s.metric}, {"n", s.n},
                       {"missing", s.missing}, {"mean", number(s.mean)}, {"std", number(s.std)},
                       {"ci95", {number(s.lo), number(s.hi)}}, {"published", s.published ? Json(*s.published) : Json()}});
  json["rows"] = std::move(rows);
  json["summary"] = std::move(summary);
  json["tests"] = tests_json(result);
  json["design"] = design_json(result.design);
  json["notes"] = result.design.notes;
  json["timing"] = result.timing;
  return json;
}

BenchResult parse_bench(const Json& json, const std::string& source) {
  try {
    if (json.at("schema") != 1) throw InputError(source + ": expected a bench result of schema 1");
    BenchResult result;
    result.design = parse_design(json);
    result.seed = json.at("seed");
    result.shard = json.value("shard", std::string());
    result.interrupted = json.value("interrupted", false);
    result.timing = json.at("timing");
    for (const Json& row : json.at("rows")) {
      BenchRow r = parse_row(result.design, row);
      const auto known = [&](const auto& list, const std::string& name) {
        return std::any_of(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
      };
      if (!known(result.design.cases, r.case_name) || !known(result.design.algorithms, r.algorithm))
        throw InputError(fmt::format("{}: row of case '{}' and algorithm '{}' is not in the design", source,
                                     r.case_name, r.algorithm));
      result.rows.push_back(std::move(r));
    }
    return result;
  } catch (const Json::exception& e) {
    throw InputError(fmt::format("{}: no result of 'outrider bench ... --json': {}", source, e.what()));
  }
}

BenchResult merge_benches(std::vector<BenchResult> parts, std::span<const std::string> sources) {
  if (parts.empty()) throw InputError("nothing to merge");
  const auto same = [](const BenchResult& r) {
    return std::tuple(r.design.bench, r.seed, r.design.options, design_json(r.design), r.design.notes);
  };
  int of = 0;
  std::set<int> seen;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    int i = 0, n = 0;
    if (std::sscanf(parts[k].shard.c_str(), "%d/%d", &i, &n) != 2)
      throw InputError(sources[k] + ": not a shard; expected a result of 'outrider bench ... --shard i/n --json'");
    if (k == 0) of = n;
    if (n != of || same(parts[k]) != same(parts[0]))
      throw InputError(fmt::format("{}: a shard of another command than {}", sources[k], sources[0]));
    if (!seen.insert(i).second) throw InputError(fmt::format("{}: shard {} is there twice", sources[k], parts[k].shard));
  }
  for (int i = 1; i <= of; ++i)
    if (!seen.contains(i)) throw InputError(fmt::format("shard {}/{} is missing", i, of));
  BenchResult whole = std::move(parts[0]);
  whole.shard.clear();
  for (std::size_t k = 1; k < parts.size(); ++k) {
    whole.interrupted = whole.interrupted || parts[k].interrupted;
    std::move(parts[k].rows.begin(), parts[k].rows.end(), std::back_inserter(whole.rows));
    for (const auto& [key, value] : parts[k].timing.items())
      if (value.is_number()) whole.timing[key] = whole.timing.value(key, 0.0) + value.get<double>();
  }
  sort_rows(whole.design, whole.rows);
  return whole;
}

}  // namespace outrider::report
