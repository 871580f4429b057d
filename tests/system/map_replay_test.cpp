// `outrider map`, `replay` and `report` from end to end.

#include <cmath>

#include "system/run.hpp"

namespace outrider::test {
namespace {

using MapAndReplay = SystemTest;

TEST_F(MapAndReplay, ConversionsKeepEveryCell) {
  for (const Args& step : std::vector<Args>{{"office1", "a.yaml"},
                                            {"a.yaml", "b.gridmap.gz"},
                                            {"b.gridmap.gz", "c.gridmap"},
                                            {"c.gridmap", "d.yaml"},
                                            {"d.yaml", "e.bt"}}) {
    const Outcome outcome = run({"map", step[0], step[1]});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
  }
  EXPECT_FALSE(slurp(dir / "a.pgm").empty());
  EXPECT_EQ(slurp(dir / "a.pgm"), slurp(dir / "d.pgm"));
  EXPECT_GT(fs::file_size(dir / "e.bt"), 100U);
  Json world = Json::parse(run({"map", "office1", "--info", "--json"}).out);
  for (const char* name : {"a.yaml", "b.gridmap.gz", "c.gridmap", "d.yaml"}) {
    world["map"] = name;
    EXPECT_EQ(Json::parse(run({"map", name, "--info", "--json"}).out), world);
  }
}

TEST_F(MapAndReplay, AFullDiskLeavesNoHalfAMap) {
  for (const char* out : {"m.yaml", "m.gridmap", "m.bt"}) {
    const Outcome outcome = run({"map", "office1", out}, {.most_bytes_a_file = 200});
    EXPECT_NE(outcome.code, 0) << out;
    EXPECT_TRUE(tree(dir).empty()) << tree(dir).begin()->first;
  }
}

TEST_F(MapAndReplay, AConvertedWorldIsExploredAsTheWorldItself) {
  spill(dir / "team.yaml", "robots:\n  - {name: a, start: [0.875, 7.375, 0]}\n");
  EXPECT_EQ(run({"map", "office1", "copy.yaml"}).code, 0);
  std::vector<Json> results;
  for (const char* world : {"office1", "copy.yaml"}) {
    const Outcome outcome = run({"explore", world, "--team", "team.yaml", "--until", "0.4", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    results.push_back(Json::parse(outcome.out)["result"]);
  }
  EXPECT_EQ(results[0], results[1]);
}

TEST_F(MapAndReplay, RawlogBecomesAMap) {
  const fs::path log = packaged_rawlog();
  if (!fs::exists(log)) GTEST_SKIP() << log << " is not installed (package mrpt-apps)";
  const Outcome outcome = run({"replay", log.string(), "--slam", "odometry", "--json", "--out", "run"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(document.is_object()) << outcome.out.substr(0, 200);
  EXPECT_EQ(document["result"]["scans"], 225);
  EXPECT_EQ(document["result"]["slam"]["method"], "odometry");
  for (const char* name : {"run.json", "map.yaml", "map.pgm", "map.bt", "report.html", "trajectories/robot1.tum"})
    EXPECT_FALSE(slurp(dir / "run" / name).empty()) << name;
  EXPECT_EQ(run({"replay", log.string(), "--slam", "odometry", "--out", "again"}).code, 0);
  for (const char* name : {"map.pgm", "trajectories/robot1.tum"})
    EXPECT_TRUE(slurp(dir / "run" / name) == slurp(dir / "again" / name)) << name;
  const Outcome quiet = run({"replay", log.string(), "--slam", "odometry", "--quiet"});
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST_F(MapAndReplay, ALogLiesOnItselfAndItsMapIsItsOwnTruth) {
  const fs::path log = packaged_rawlog();
  if (!fs::exists(log)) GTEST_SKIP() << log << " is not installed (package mrpt-apps)";
  const Outcome alone = run({"replay", log.string(), "--resolution", "0.2", "--out", "one"});
  EXPECT_EQ(alone.code, 0) << alone.err;
  const Outcome outcome = run({"replay", log.string(), log.string(), "--unknown-starts", "--resolution", "0.2",
                               "--true-map", "one/map.yaml", "--json", "--out", "two"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(document.is_object()) << outcome.out.substr(0, 200);
  const Json& result = document["result"];
  ASSERT_EQ(result["merge"].size(), 1U);
  EXPECT_TRUE(result["merge"][0]["accepted"].get<bool>()) << result["merge"][0];
  for (const Json& value : result["merge"][0]["transform"]) EXPECT_NEAR(value.get<double>(), 0.0, 0.1);
  EXPECT_GT(result["overlap"]["fraction"].get<double>(), 0.9);
  EXPECT_GT(result["map_quality"]["within_tolerance"]["precision"].get<double>(), 0.9);
  EXPECT_GT(result["self_consistency"]["end_points_agree"].get<double>(), 0.9);
  for (const char* name : {"map.yaml", "map.bt", "robots/robot1/map.yaml", "robots/robot2/map.yaml",
                           "trajectories/robot2.tum", "report.html"})
    EXPECT_FALSE(slurp(dir / "two" / name).empty()) << name;
}

TEST_F(MapAndReplay, ReportComparesRuns) {
  for (const char* name : {"ia", "ta"})
    EXPECT_EQ(run({"explore", "office1", "--until", "0.3", "--coordinator", name, "--out", name}).code, 0);
  const Outcome outcome = run({"report", "ia", "ta", "--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(Json::accept(outcome.out));
  spill(dir / "ia/run.json", "{\"schema\": 2}");
  const Outcome broken = run({"report", "ia", "ta"});
  EXPECT_EQ(broken.code, 2);
  EXPECT_NE(broken.err.find("ia/run.json"), std::string::npos) << broken.err;
}

}  // namespace
}  // namespace outrider::test
