// Robots that meet where there is no room for two: with and without radio, nobody waits for ever.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "explorer/mission.hpp"
#include "sim/world.hpp"

namespace outrider::explorer {
namespace {

std::vector<RobotSpec> team_on(const sim::World& world, std::size_t n, double range) {
  std::vector<RobotSpec> team;
  for (std::size_t i = 0; i < n; ++i)
    team.push_back({.name = std::string("r") + std::to_string(i + 1), .start = world.starts[i], .range = range, .radius = 0.2});
  return team;
}

void expect_home(const sim::World& world, const MissionResult& result) {
  const auto& g = world.map.geometry();
  for (const auto& robot : result.robots)
    EXPECT_EQ(g.cell_of(robot.trajectory.back().pose.position()), g.cell_of(robot.spec.start.position())) << robot.spec.name;
}

struct Air {
  const char* name;
  bool none;
};

class Encounters : public testing::TestWithParam<Air> {
 protected:
  MissionResult run(const sim::World& world, const std::vector<RobotSpec>& team) const {
    MissionSettings settings;
    settings.coordinator = "dvf";
    settings.explorer.return_home = true;
    settings.radio.none = GetParam().none;
    return run_mission(world.map, team, settings);
  }
};

// Each one's unexplored end is behind the other: without radio they have to pass, with it they turn round.
TEST_P(Encounters, FaceToFaceInACorridorOneRobotWide) {
  const sim::World world = sim::parse_world(R"(resolution: 0.5
map:
########################
#0.........#..........1#
#######..........#######
########################
)", "corridor with a wide middle");
  const auto result = run(world, team_on(world, 2, 1.0));
  EXPECT_EQ(result.status, MissionStatus::kExplored);
  expect_home(world, result);
}

TEST_P(Encounters, FaceToFaceWithOneBay) {
  const sim::World world = sim::parse_world(R"(resolution: 0.5
map:
#########.##########
#0................1#
#########.##########
####################
)", "corridor with a bay");
  const auto result = run(world, team_on(world, 2, 1.0));
  EXPECT_EQ(result.status, MissionStatus::kExplored);
  expect_home(world, result);
}

// The deepest robot leaves last and has to come back first: they have to talk about that.
TEST_P(Encounters, AQueueOfFourComesHomeInAnyOrder) {
  if (GetParam().none) GTEST_SKIP() << "nobody knows who wants where";
  const sim::World world = sim::parse_world(R"(resolution: 0.5
map:
####################
#.......############
#.......############
#..........0.1.2.3.#
#.......############
#.......############
####################
)", "dead end");
  const auto result = run(world, team_on(world, 4, 2.0));
  EXPECT_EQ(result.status, MissionStatus::kExplored);
  expect_home(world, result);
}

TEST_P(Encounters, AQueueOfFourMeetsAQueueOfFour) {
  const sim::World world = sim::parse_world(R"(resolution: 0.5
map:
###########################
#....###############......#
#0.2.###############.4.6..#
#........................##
#1.3.###############.5.7..#
#....###############......#
###########################
)", "two rooms, one corridor");
  const auto result = run(world, team_on(world, 8, 2.0));
  EXPECT_EQ(result.status, MissionStatus::kExplored);
  expect_home(world, result);
}

INSTANTIATE_TEST_SUITE_P(Air, Encounters, testing::Values(Air{"ideal", false}, Air{"none", true}),
                         [](const auto& instance) { return std::string(instance.param.name); });

}  // namespace
}  // namespace outrider::explorer
