#include "explorer/mission.hpp"
#include "explorer/scan_mapper.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "sim/world.hpp"

namespace outrider::explorer {
namespace {

constexpr const char* kTwoRooms = R"(resolution: 0.5
map:
########################
#..........#...........#
#.0.1......#...........#
#......................#
#......................#
#.2.3......#...........#
#..........#...........#
########################
)";

std::vector<RobotSpec> team_for(const sim::World& world, int n, double radius = 0.2) {
  const std::vector<double> radii(static_cast<std::size_t>(n), radius);
  const auto starts = sim::spread_starts(world, radii);
  std::vector<RobotSpec> team;
  for (int i = 0; i < n; ++i)
    team.push_back({.name = std::string("r") + std::to_string(i + 1), .start = starts[static_cast<std::size_t>(i)],
                    .speed = 0.5 + 0.1 * (i % 3), .range = 2.0 + i % 2, .radius = radius});
  return team;
}

std::size_t unknown_but_reachable(const OccupancyGrid& truth, const std::vector<RobotSpec>& team,
                                  const OccupancyGrid& map) {
  const auto reachable = reachable_area(truth, team);
  std::size_t count = 0;
  for (std::size_t i = 0; i < map.size(); ++i) count += reachable[i] && map[i] == CellState::kUnknown;
  return count;
}

class EveryCoordinator : public testing::TestWithParam<std::string> {};

std::vector<std::string> names() {
  std::vector<std::string> list;
  for (const auto& info : coordinators()) list.push_back(info.name);
  return list;
}

TEST_P(EveryCoordinator, ExploresEverythingAndWithIdealRadioAllMapsAreEqual) {
  const sim::World world = sim::parse_world(kTwoRooms, "two rooms");
  for (const int n : {1, 2, 4}) {
    SCOPED_TRACE(n);
    const auto team = team_for(world, n);
    MissionSettings settings;
    settings.coordinator = GetParam();
    const MissionResult result = run_mission(world.map, team, settings);
    EXPECT_EQ(result.status, MissionStatus::kExplored);
    EXPECT_DOUBLE_EQ(result.explored_fraction, 1.0);
    EXPECT_EQ(unknown_but_reachable(world.map, team, result.map), 0U);
    EXPECT_TRUE(result.maps_equal);
    for (std::size_t i = 0; i < result.map.size(); ++i)
      ASSERT_TRUE(result.map[i] == CellState::kUnknown || result.map[i] == world.map[i]) << "cell " << i;
  }
}

TEST_P(EveryCoordinator, IsDeterministic) {
  const sim::World world = sim::parse_world(kTwoRooms, "two rooms");
  MissionSettings settings;
  settings.coordinator = GetParam();
  const auto a = run_mission(world.map, team_for(world, 3), settings);
  const auto b = run_mission(world.map, team_for(world, 3), settings);
  EXPECT_EQ(a.mission_time_s, b.mission_time_s);
  ASSERT_EQ(a.events.size(), b.events.size());
  for (std::size_t r = 0; r < a.robots.size(); ++r) EXPECT_EQ(a.robots[r].trajectory, b.robots[r].trajectory);
  EXPECT_EQ(a.known_since, b.known_since);
}

TEST_P(EveryCoordinator, FinishesWhenARobotDiesOnTheWay) {
  const sim::World world = sim::parse_world(kTwoRooms, "two rooms");
  MissionSettings settings;
  settings.coordinator = GetParam();
  settings.faults = {{.kind = Fault::Kind::kKill, .robot = 0, .t = 2.0}};
  const auto result = run_mission(world.map, team_for(world, 3), settings);
  EXPECT_EQ(result.status, MissionStatus::kExplored);
}

TEST_P(EveryCoordinator, ExploresWithoutAnyRadio) {
  const sim::World world = sim::parse_world(kTwoRooms, "two rooms");
  MissionSettings settings;
  settings.coordinator = GetParam();
  settings.radio.none = true;
  const auto team = team_for(world, 2);
  const auto result = run_mission(world.map, team, settings);
  EXPECT_EQ(result.status, MissionStatus::kExplored);
  for (const auto& robot : result.robots) EXPECT_EQ(unknown_but_reachable(world.map, team, robot.map), 0U);
}

INSTANTIATE_TEST_SUITE_P(All, EveryCoordinator, testing::ValuesIn(names()), [](const auto& instance) {
  std::string name = instance.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST(Mission, AWorldWithAClosedRoomIsExploredAndTheRoomIsNotReachable) {
  const sim::World world = sim::parse_world(R"(resolution: 0.5
map:
###############
#.0....#......#
#......#......#
#......#......#
###############
)", "closed room");
  const auto team = team_for(world, 1);
  const auto result = run_mission(world.map, team, {});
  EXPECT_EQ(result.status, MissionStatus::kExplored);
  EXPECT_NEAR(result.reachable_m2, 18 * 0.25, 1e-9);
  EXPECT_TRUE(result.left.empty());
}

// Where one frontier cell cannot be looked behind, its neighbour can: corners of narrow passages, short-sighted robot.
TEST(Mission, ACornerIsSeenFromTheNextCell) {
  const sim::World world = sim::parse_world(R"(resolution: 0.5
map:
#########
#..0....#
#.#####.#
#...###.#
#######.#
#.......#
#.#######
#.......#
#########
)", "corners");
  std::vector<RobotSpec> team = team_for(world, 1);
  team[0].range = 0.8;
  for (const auto& info : coordinators()) {
    MissionSettings settings;
    settings.coordinator = info.name;
    const auto result = run_mission(world.map, team, settings);
    EXPECT_EQ(unknown_but_reachable(world.map, team, result.map), 0U) << info.name;
  }
}

TEST(Mission, AGapTooNarrowForTheRobotIsReportedWithItsReason) {
  const sim::World world = sim::parse_world(R"(resolution: 0.5
map:
#########################
#......#................#
#..0....................#
#......#................#
#########################
)", "narrow door");
  auto team = team_for(world, 1, 0.45);
  team[0].range = 3.0;
  const auto result = run_mission(world.map, team, {});
  ASSERT_FALSE(result.left.empty());
  EXPECT_TRUE(std::any_of(result.left.begin(), result.left.end(),
                          [](const Left& left) { return left.why == LeftReason::kUnreachable; }));
}

TEST(Mission, StopsAtTheFractionAskedForAndAtTheTimeLimit) {
  const sim::World world = sim::parse_world(kTwoRooms, "two rooms");
  MissionSettings settings;
  settings.until = 0.6;
  const auto part = run_mission(world.map, team_for(world, 1), settings);
  EXPECT_EQ(part.status, MissionStatus::kExplored);
  EXPECT_GE(part.explored_fraction, 0.6);
  EXPECT_LT(part.explored_fraction, 1.0);
  settings.until = 1.0;
  settings.max_time_s = 1.0;
  const auto brief = run_mission(world.map, team_for(world, 1), settings);
  EXPECT_EQ(brief.status, MissionStatus::kTimeout);
  EXPECT_NEAR(brief.mission_time_s, 1.0, 1e-9);
}

TEST(Mission, EverybodyReturnsToTheStartWhenAsked) {
  const sim::World world = sim::parse_world(kTwoRooms, "two rooms");
  MissionSettings settings;
  settings.explorer.return_home = true;
  const auto team = team_for(world, 4);
  const auto result = run_mission(world.map, team, settings);
  EXPECT_EQ(result.status, MissionStatus::kExplored);
  EXPECT_GT(result.mission_time_s, result.time_s);
  for (std::size_t r = 0; r < team.size(); ++r) {
    const auto& g = world.map.geometry();
    EXPECT_EQ(g.cell_of(result.robots[r].trajectory.back().pose.position()), g.cell_of(team[r].start.position()));
  }
}

// One robot wide, a bay in the middle: whoever goes first, nobody may wait for ever.
TEST(Mission, RobotsInACorridorLetEachOtherPass) {
  const sim::World world = sim::parse_world(R"(resolution: 0.5
map:
#########.########
#0..............1#
#########.########
)", "corridor");
  std::vector<RobotSpec> team = team_for(world, 2);
  for (auto& robot : team) robot.range = 1.0;
  MissionSettings settings;
  settings.coordinator = "nearest";
  settings.explorer.return_home = true;
  const auto result = run_mission(world.map, team, settings);
  EXPECT_EQ(result.status, MissionStatus::kExplored);
}

TEST(Mission, LidarFindsTheSameRoomsAsTheCellSensor) {
  const sim::World world = sim::parse_world(kTwoRooms, "two rooms");
  MissionSettings settings;
  settings.sim.lidar = true;
  settings.make_mapper = make_scan_mapper;
  const auto team = team_for(world, 2);
  const auto result = run_mission(world.map, team, settings);
  EXPECT_EQ(result.status, MissionStatus::kExplored);
  EXPECT_TRUE(result.maps_equal);
}

TEST(Coordinators, AnUnknownNameIsRefusedWithTheNearestNames) {
  try {
    make_coordinator("burgrad", {});
    FAIL() << "accepted";
  } catch (const std::exception& e) {
    EXPECT_NE(std::string(e.what()).find("'burgard'"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace outrider::explorer
