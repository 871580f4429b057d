#include "report/bench_result.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "world/error.hpp"

namespace outrider::report {
namespace {

BenchResult sample() {
  BenchResult r;
  r.design.bench = "sample";
  r.design.cases = {{"near", "field", 3}, {"far", "field", 2}};
  r.design.algorithms = {{"a", "first"}, {"b", "second"}};
  r.design.metrics = {{"time_s", "s"}, {"overlap", "", 3, false}};
  r.design.references = {"a"};
  r.design.published = {{"near", "b", "time_s", 7.0}};
  r.design.options = {{"world", "field"}};
  r.design.notes = {"a note, with \"quotes\" & <tags>"};
  double t = 1.0;
  for (const auto& c : r.design.cases)
    for (int trial = 1; trial <= c.trials; ++trial)
      for (const auto& a : r.design.algorithms) {
        BenchRow row{c.name, trial, a.name, {{"time_s", t}, {"overlap", 0.1 * t}}, Json::object()};
        t = std::fmod(t * 1.7 + 1.0 / 3.0, 9.0);
        r.rows.push_back(row);
      }
  r.rows[3].metrics[0].second.reset();  // never
  r.rows[4].extra["goals"] = 5;
  return r;
}

/// Shard k of n as the runner deals trials out: by (case, trial).
std::vector<BenchResult> shards_of(const BenchResult& whole, int n) {
  std::vector<BenchResult> parts(static_cast<std::size_t>(n), whole);
  for (int k = 0; k < n; ++k) {
    auto& part = parts[static_cast<std::size_t>(k)];
    part.shard = std::to_string(k + 1) + "/" + std::to_string(n);
    part.rows.clear();
    for (std::size_t i = 0; i < whole.rows.size(); ++i)
      if (static_cast<int>(i / 2) % n == k) part.rows.push_back(whole.rows[i]);
  }
  return parts;
}

TEST(BenchResult, JsonHasTheContractsShape) {
  const Json json = bench_json(sample());
  EXPECT_EQ(json["bench"], "sample");
  const Json& row = json["rows"][4];
  EXPECT_EQ(row["case"], "near");
  EXPECT_EQ(row["map"], "field");
  EXPECT_EQ(row["trial"], 3);
  EXPECT_EQ(row["algorithm"], "a");
  EXPECT_EQ(row["goals"], 5);
  EXPECT_TRUE(json["rows"][3]["time_s"].is_null());
  const Json& s = json["summary"][2];  // near, b, time_s
  EXPECT_EQ(s["algorithm"], "b");
  EXPECT_EQ(s["n"], 2);
  EXPECT_EQ(s["missing"], 1);
  EXPECT_EQ(s["published"], 7.0);
  EXPECT_TRUE(json["summary"][0]["published"].is_null());
  for (const char* key : {"case", "metric", "a", "b", "test", "statistic", "df", "p"})
    EXPECT_TRUE(json["tests"][0].contains(key)) << key;
  EXPECT_EQ(json["tests"].size(), 4U);  // two cases, one tested metric, paired and Welch
}

TEST(BenchResult, ReadsWhatItWrote) {
  const std::string text = to_text(bench_json(sample()));
  EXPECT_EQ(to_text(bench_json(parse_bench(Json::parse(text), "x"))), text);
}

TEST(BenchResult, ShardsMergeIntoTheWholeInAnyOrder) {
  const BenchResult whole = sample();
  for (const int n : {1, 2, 3, 5, 7}) {
    auto parts = shards_of(whole, n);
    std::reverse(parts.begin(), parts.end());
    std::vector<BenchResult> read;
    for (const auto& part : parts) read.push_back(parse_bench(Json::parse(to_text(bench_json(part))), "x"));
    const std::vector<std::string> names(parts.size(), "part");
    EXPECT_EQ(to_text(bench_json(merge_benches(read, names))), to_text(bench_json(whole))) << n;
  }
}

TEST(BenchResult, RefusesWhatDoesNotFitTogether) {
  const auto parts = shards_of(sample(), 3);
  const std::vector<std::string> names{"x", "y", "z"};
  EXPECT_THROW(merge_benches({parts[0], parts[1]}, names), InputError);            // one is missing
  EXPECT_THROW(merge_benches({parts[0], parts[1], parts[1]}, names), InputError);  // one twice
  auto other = parts;
  other[2].seed = 2;
  EXPECT_THROW(merge_benches(other, names), InputError);
  other = parts;
  other[2].design.options["world"] = "office";
  EXPECT_THROW(merge_benches(other, names), InputError);
  EXPECT_THROW(merge_benches({sample()}, names), InputError);  // no shard
  EXPECT_THROW(parse_bench(Json::parse("{}"), "x"), InputError);
  EXPECT_THROW(parse_bench(Json::parse(R"({"schema": 2})"), "x"), InputError);
}

TEST(BenchResult, PairsOnlyTrialsThatBothFinished) {
  const PairedValues v = paired_values(sample(), "near", "time_s", "a", "b");
  ASSERT_EQ(v.a.size(), 2U);  // trial 2 of b never got there
  EXPECT_EQ(v.a[0], 1.0);
}

TEST(BenchResult, TablesShowPublishedAndMissing) {
  const auto tables = bench_tables(sample());
  ASSERT_FALSE(tables.empty());
  const std::string text = table_text(tables[0]);
  EXPECT_NE(text.find("[7]"), std::string::npos) << text;
  EXPECT_NE(text.find("(1 never)"), std::string::npos) << text;
  for (const Table& table : tables)
    for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size());
}

TEST(BenchResult, CsvHasALineARow) {
  const std::string csv = bench_csv(sample());
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 11);
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "case,map,trial,algorithm,time_s,overlap");
  EXPECT_NE(csv.find("near,field,2,b,,"), std::string::npos) << csv;
}

TEST(BenchResult, PageEscapesText) {
  const BenchResult r = sample();
  const std::string html = bench_html(r, bench_tables(r), "");
  EXPECT_EQ(html.find("<tags>"), std::string::npos);
  EXPECT_NE(html.find("&lt;tags&gt;"), std::string::npos);
}

TEST(Table, ColumnsAlignAndQuotesSurvive) {
  const Table table{"title", {"name", "t ± s"}, {{"a", "1.0 ± 0.5"}, {"longer", "2"}}, "note"};
  EXPECT_EQ(table_text(table), "title\nname        t ± s\na       1.0 ± 0.5\nlonger          2\nnote\n");
  EXPECT_EQ(csv_field("a,\"b\""), "\"a,\"\"b\"\"\"");
  EXPECT_EQ(csv_field("plain"), "plain");
}

}  // namespace
}  // namespace outrider::report
