// Missions on topological maps as files: what is written reads back, what is wrong is named.

#include "explorer/mission_file.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <fstream>
#include <sstream>

#include "world/error.hpp"

namespace outrider::explorer {
namespace {

namespace fs = std::filesystem;

const char* const kMission = R"(waypoints:
  - {id: a, x: 0, y: 0, state: dead-end}
  - {id: b, x: 3, y: 4, theta: 1.5, landmark: 7}
  - {id: 12, x: 3, y: 0, state: corridor}
paths:
  - {from: a, to: b}
  - {from: b, to: 12, cost: 2.5, rule: exit 1, deviation: {12: 0.8, a: 0.1, b: 0.1}}
  - {from: a, to: 12, two_way: true, via: [[1, 1], [2, 1]]}
robots:
  - {name: r1, at: a}
  - {at: 12, speed: 2}
goals: [b, 12]
)";

class MissionFile : public ::testing::Test {
 protected:
  fs::path write(const std::string& text, const std::string& name = "mission.yaml") {
    const fs::path path = dir_ / name;
    std::ofstream(path) << text;
    return path;
  }
  std::string complaint(const std::string& text, const std::string& name = "mission.yaml") {
    try {
      name.ends_with(".graph") ? static_cast<void>(read_graph(write(text, name))) : static_cast<void>(read_mission(write(text)));
    } catch (const InputError& e) {
      return e.what();
    }
    return "no complaint";
  }
  /// kMission with one piece of text replaced.
  std::string with(const std::string& old, const std::string& now) {
    std::string text = kMission;
    const auto at = text.find(old);
    EXPECT_NE(at, std::string::npos) << old;
    return text.replace(at, old.size(), now);
  }
  void SetUp() override {
    dir_ = fs::temp_directory_path() / ("outrider_mission_" + std::to_string(::getpid()));
    fs::create_directories(dir_);
  }
  void TearDown() override { fs::remove_all(dir_); }

 private:
  fs::path dir_;
};

TEST_F(MissionFile, IsReadWithDefaults) {
  const auto m = read_mission(write(kMission));
  ASSERT_EQ(m.map.waypoints.size(), 3U);
  EXPECT_EQ(m.map.waypoints[0].state, decision::SemanticState::kDeadEnd);
  EXPECT_EQ(m.map.waypoints[1].landmark, 7);
  ASSERT_EQ(m.map.paths.size(), 4U);
  EXPECT_DOUBLE_EQ(m.map.paths[0].cost, 5.0);  // straight
  EXPECT_EQ(m.map.paths[1].rule, (decision::SupervisionRule{decision::SupervisionRule::Kind::kExit, 1}));
  EXPECT_EQ(m.map.paths[1].outcomes.size(), 3U);
  EXPECT_DOUBLE_EQ(m.map.paths[2].cost, 2 * std::sqrt(2.0) + 1.0);
  EXPECT_EQ(m.map.paths[3].from, 2);
  EXPECT_EQ(m.map.paths[3].via.front().x, 2.0);
  EXPECT_EQ(m.robots[1].name, "robot2");
  EXPECT_EQ(m.robots[1].at, 2);
  EXPECT_EQ(m.goals, (std::vector<int>{1, 2}));
}

TEST_F(MissionFile, WritingAndReadingGivesTheSame) {
  const auto m = read_mission(write(kMission));
  const std::string text = mission_text(m);
  EXPECT_EQ(mission_text(read_mission(write(text))), text);
}

TEST_F(MissionFile, NamesLineAndKeyOfWhatIsWrong) {
  EXPECT_NE(complaint(with("state: dead-end", "state: deadend")).find(":2: state: unknown 'deadend'; did you mean 'dead-end'"), std::string::npos);
  EXPECT_NE(complaint(with("id: b", "id: a")).find(":3: id: 'a' is taken"), std::string::npos);
  EXPECT_NE(complaint(with("cost: 2.5", "cost: -1")).find(":7: cost"), std::string::npos);
  EXPECT_NE(complaint(with("cost: 2.5", "cost: 0")).find("above 0"), std::string::npos);
  EXPECT_NE(complaint(with("cost: 2.5", "cost: .nan")).find(":7: cost"), std::string::npos);
  EXPECT_NE(complaint(with("to: b}", "to: bb}")).find(":6: to: there is no waypoint 'bb'; did you mean 'b'"), std::string::npos);
  EXPECT_NE(complaint(with("12: 0.8", "12: 0.7")).find("sum to 0.9"), std::string::npos);
  EXPECT_NE(complaint(with("12: 0.8, a: 0.1", "12: 0.2, a: 0.7")).find("highest"), std::string::npos);
  EXPECT_NE(complaint(with("12: 0.8, a: 0.1", "a: 1.5")).find("deviation to 'a': expected a number from 0 to 1"), std::string::npos);
  EXPECT_NE(complaint(with("goals: [b, 12]", "goals: [b, b]")).find(":12: goals: 'b' twice"), std::string::npos);
  EXPECT_NE(complaint(with("name: r1", "name: 'r 1'")).find("name: expected letters"), std::string::npos);
  EXPECT_NE(complaint(with("robots:", "robot:")).find("unknown key 'robot'; did you mean 'robots'"), std::string::npos);
  EXPECT_NE(complaint(with("from: a, to: b", "from: a, to: a")).find("another waypoint"), std::string::npos);
  EXPECT_NE(complaint(with("from: a, to: b", "from: a, to: 12")).find("twice"), std::string::npos);
  EXPECT_NE(complaint("waypoints: [").find("mission.yaml:"), std::string::npos);
  EXPECT_NE(complaint("waypoints: []\nrobots: []\ngoals: []\n").find("waypoints: expected at least one"), std::string::npos);
  EXPECT_NE(complaint("").find("expected a mission"), std::string::npos);
}

const char* const kGraph = "2\n10 20\n0.5\n1 2\n\n0\n4 6\n1\n1\nE\n8\n\n1\n12 6\n1\n0\nW\n8\n";

TEST_F(MissionFile, GraphsComeInMetres) {
  const auto map = read_graph(write(kGraph, "g.graph"));
  ASSERT_EQ(map.waypoints.size(), 2U);
  EXPECT_DOUBLE_EQ(map.waypoints[0].pose.x, 3.0);
  EXPECT_DOUBLE_EQ(map.waypoints[1].pose.x, 7.0);
  EXPECT_DOUBLE_EQ(map.waypoints[1].pose.y, 5.0);
  EXPECT_DOUBLE_EQ(map.paths[0].cost, 4.0);
}

TEST_F(MissionFile, DamagedGraphsAreRefused) {
  const std::string graph = kGraph;
  for (std::size_t cut = 1; cut + 2 < graph.size(); ++cut)
    if (graph[cut] == '\n') {
      EXPECT_NE(complaint(graph.substr(0, cut), "g.graph"), "no complaint") << cut;
    }
  EXPECT_NE(complaint(graph + "7\n", "g.graph").find("expected the end"), std::string::npos);
  std::string bad = graph;
  bad[graph.find("E")] = 'Q';
  EXPECT_NE(complaint(bad, "g.graph").find("g.graph:10: direction"), std::string::npos);
}

TEST(Graphs, OfPatrollingSimLieInFreeSpace) {
  const fs::path maps = fs::path(OUTRIDER_SOURCE_DIR) / "../shared/data/maps/patrolling_sim";
  if (!fs::exists(maps)) GTEST_SKIP() << maps << " is not here";
  for (const std::string name : {"grid", "cumberland", "example"}) {
    const auto map = read_graph(maps / name / (name + ".graph"));
    EXPECT_GE(map.waypoints.size(), 25U);
    for (const auto& c : decision::costs_to(map, 0)) EXPECT_LT(c, 1e6) << name;
    for (const auto& p : map.paths)
      EXPECT_GE(p.cost, 0.75 * distance(map.waypoints[static_cast<std::size_t>(p.from)].pose.position(),
                                       map.waypoints[static_cast<std::size_t>(p.to)].pose.position())) << name;
  }
}

}  // namespace
}  // namespace outrider::explorer
