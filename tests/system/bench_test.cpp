// What a user of `outrider bench` relies on: the document, shards, threads, clear refusals.

#include <fstream>
#include <map>

#include "system/run.hpp"

namespace outrider::test {
namespace {

class Bench : public SystemTest {
 protected:
  /// A short bench; `more` is added to its command line.
  Json short_bench(const std::vector<std::string>& more) const {
    std::vector<std::string> command{"bench", "dai2014", "--trials", "2", "--cases", "random,random-many",
                                     "--algorithms", "daa,nearest", "--json", "-q"};
    command.insert(command.end(), more.begin(), more.end());
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return Json::parse(outcome.out, nullptr, false);
  }
};

TEST_F(Bench, ThreadsAndShardsDoNotChangeTheResult) {
  Json whole = short_bench({});
  ASSERT_TRUE(whole.is_object());
  EXPECT_EQ(whole["rows"].size(), 8U);
  whole.erase("timing");
  Json threads = short_bench({"--jobs", "3"});
  threads.erase("timing");
  EXPECT_EQ(threads.dump(), whole.dump());
  std::vector<std::string> merge{"bench", "--merge"};
  for (const char* shard : {"3/3", "1/3", "2/3"}) {
    const fs::path file = dir / (std::string("shard") + shard[0] + ".json");
    std::ofstream(file) << short_bench({"--shard", shard}).dump();
    merge.push_back(file.string());
  }
  merge.push_back("--json");
  const Outcome merged = run(merge);
  EXPECT_EQ(merged.code, 0) << merged.err;
  Json document = Json::parse(merged.out, nullptr, false);
  ASSERT_TRUE(document.is_object()) << merged.out.substr(0, 200);
  document.erase("timing");
  EXPECT_EQ(document.dump(), whole.dump());
}

TEST_F(Bench, AnotherSeedDrawsOtherPlacements) {
  const Json a = short_bench({}), b = short_bench({"--seed", "2"});
  EXPECT_EQ(a["rows"][0].dump(), b["rows"][0].dump());  // the paper's placement
  EXPECT_NE(a["rows"][4].dump(), b["rows"][4].dump());  // a random one
}

// Without a radio everybody explores everything: whatever else changes, that takes longer.
TEST_F(Bench, MatignonRunsItsConditionsOnTheSameTrials) {
  const Outcome outcome = run({"bench", "matignon2012", "--trials", "2", "--world", "office2", "--json", "-q", "--out",
                               (dir / "matignon").string()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(document.is_object());
  std::map<std::string, double> time;
  for (const Json& row : document["rows"]) time[row["algorithm"]] += row["exploration_time_s"].get<double>();
  for (const char* other : {"permanent", "breaks+independent", "breaks+dvf"}) EXPECT_GT(time["none"], time[other]) << other;
  std::ifstream page(dir / "matignon" / "report.html");
  const std::string html((std::istreambuf_iterator<char>(page)), std::istreambuf_iterator<char>());
  EXPECT_NE(html.find("<svg"), std::string::npos);
}

TEST_F(Bench, RefusesNonsense) {
  for (const std::vector<std::string>& command : std::vector<std::vector<std::string>>{
           {"bench"}, {"bench", "dai2041"}, {"bench", "dai2014", "--shard", "3/2"}, {"bench", "dai2014", "--shard", "x"},
           {"bench", "dai2014", "--trials", "0"}, {"bench", "dai2014", "--world", "nowhere"},
           {"bench", "--merge", "/dev/null"}, {"bench", "--merge", "nothing.json"}}) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.code, 2) << command.back();
    EXPECT_TRUE(outcome.out.empty());
    EXPECT_FALSE(outcome.err.empty());
  }
}

}  // namespace
}  // namespace outrider::test
