// What a user of `outrider allocate` relies on.

#include "system/run.hpp"

namespace outrider::test {
namespace {

class Allocate : public SystemTest {};

const char* const kMission = R"(waypoints:
  - {id: a, x: 0, y: 0}
  - {id: b, x: 4, y: 0}
  - {id: c, x: 4, y: 3}
  - {id: d, x: 0, y: 3}
paths:
  - {from: a, to: b, two_way: true}
  - {from: b, to: c, two_way: true}
  - {from: c, to: d, two_way: true}
  - {from: d, to: a, two_way: true}
robots:
  - {name: left, at: a}
  - {name: right, at: b}
goals: [c, d]
)";

TEST_F(Allocate, EveryProtocolAllocatesAMissionFile) {
  spill(dir / "mission.yaml", kMission);
  for (const char* protocol : {"continuous", "ssa", "dssa", "optimal", "scout"}) {
    const auto outcome = run({"allocate", "mission.yaml", "--protocol", protocol, "--json"});
    ASSERT_EQ(outcome.code, 0) << protocol << outcome.err;
    const Json result = Json::parse(outcome.out)["result"];
    EXPECT_EQ(result["allocation"]["left"], Json({"d"})) << protocol;
    EXPECT_EQ(result["allocation"]["right"], Json({"c"})) << protocol;
    EXPECT_NEAR(result["duration"].get<double>(), 3.0, 1e-5);
    EXPECT_NEAR(result["movement"].get<double>(), 6.0, 1e-5);
    for (const char* key : {"value", "iterations", "modifications", "messages", "policy_solves"}) EXPECT_TRUE(result.contains(key)) << key;
  }
}

TEST_F(Allocate, ADrawnMissionIsTheSameForTheSameSeedAndWritesItsFolder) {
  const Args args{"allocate", "--map", "urban", "--goals", "8", "--robots", "3", "--seed", "5"};
  Args a = args, b = args;
  a.insert(a.end(), {"--out", "a"});
  b.insert(b.end(), {"--out", "b", "--jobs", "2"});
  ASSERT_EQ(run(a).code, 0);
  ASSERT_EQ(run(b).code, 0);
  for (const char* file : {"mission.yaml", "allocation.csv", "report.html"}) EXPECT_EQ(slurp(dir / "a" / file), slurp(dir / "b" / file)) << file;
  const auto again = run({"allocate", "a/mission.yaml", "--seed", "5", "--json"});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(Json::parse(again.out)["result"]["allocation"], Json::parse(slurp(dir / "a/run.json"))["result"]["allocation"]);
}

TEST_F(Allocate, LossAndDelayChangeNothingButTheMessages) {
  const auto outcome = run({"allocate", "--map", "labyrinth", "--goals", "9", "--comms", "loss:0.3,delay:0.05", "--json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out)["result"]["status"], "allocated");
}

TEST_F(Allocate, WhatNobodyCanReachIsLeftAndSaidSo) {
  std::string text = kMission;
  text.replace(text.find("paths:"), 6, "  - {id: island, x: 9, y: 9}\npaths:");
  text.replace(text.find("[c, d]"), 6, "[c, island]");
  spill(dir / "mission.yaml", text);
  for (const char* protocol : {"continuous", "ssa", "dssa", "optimal", "scout"}) {
    const auto outcome = run({"allocate", "mission.yaml", "--protocol", protocol, "--json"});
    EXPECT_EQ(outcome.code, 1) << protocol;
    EXPECT_EQ(Json::parse(outcome.out)["result"]["left"], Json({"island"})) << protocol;
  }
}

TEST_F(Allocate, BadUsageEndsWithTwoAndAReason) {
  spill(dir / "mission.yaml", kMission);
  for (const Args& args : std::vector<Args>{{"allocate"},
                                            {"allocate", "nowhere.yaml"},
                                            {"allocate", "mission.yaml", "--protocol", "nosuch"},
                                            {"allocate", "mission.yaml", "--noc", "-1"},
                                            {"allocate", "mission.yaml", "--comms", "range:3"},
                                            {"allocate", "mission.yaml", "--execute"},
                                            {"allocate", "--map", "urban", "--goals", "250"},
                                            {"allocate", "--map", "urban", "--goals", "17", "--protocol", "optimal"}}) {
    const auto outcome = run(args);
    EXPECT_EQ(outcome.code, 2) << args.back();
    EXPECT_FALSE(outcome.err.empty());
    EXPECT_TRUE(outcome.out.empty());
  }
}

}  // namespace
}  // namespace outrider::test
