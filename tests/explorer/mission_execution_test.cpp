// Whole missions in the lidar simulator, driven by the local model with drifting odometers.

#include "explorer/mission_execution.hpp"

#include <gtest/gtest.h>

#include "decision/grid_topology.hpp"
#include "explorer/mission.hpp"
#include "explorer/mission_draw.hpp"
#include "sim/world.hpp"

namespace outrider::explorer {
namespace {

ExecutionSettings settings(std::uint64_t seed) {
  ExecutionSettings s;
  s.robot = {.speed = 1.0, .range = 5.0, .radius = 0.2};
  s.allocation.seed = s.seed = seed;
  return s;
}

TEST(MissionExecution, ThreeRobotsReachNineGoalsInTheUrbanWorldInSpiteOfDrift) {
  const OccupancyGrid truth = solid_map(sim::embedded_world("urban").map);
  const auto map = decision::topology_of(truth, {.radius = 0.2});
  const auto mission = draw_mission(map, 9, 3, Starts::kApart, 1);
  const ExecutionSettings s = settings(1);
  const auto run = execute(truth, mission, s);
  EXPECT_TRUE(run.missed.empty());
  EXPECT_LT(run.worst_arrival_m, 0.6);
  double drift = 0.0;
  for (const auto& robot : run.robots) {
    EXPECT_TRUE(robot.done);
    drift = std::max(drift, robot.worst_drift_m);
  }
  EXPECT_GT(drift, 0.1);  // it was no easy drive
  const auto again = execute(truth, mission, s);
  EXPECT_EQ(again.time_s, run.time_s);
  EXPECT_EQ(again.robots[0].trajectory, run.robots[0].trajectory);
}

TEST(MissionExecution, TheLabyrinthToo) {
  const OccupancyGrid truth = solid_map(sim::embedded_world("labyrinth").map);
  const auto map = decision::topology_of(truth, {.radius = 0.2});
  const auto run = execute(truth, draw_mission(map, 6, 2, Starts::kApart, 3), settings(3));
  EXPECT_TRUE(run.missed.empty());
}

TEST(MissionExecution, NoTimeNoGoals) {
  const OccupancyGrid truth = solid_map(sim::embedded_world("urban").map);
  const auto mission = draw_mission(decision::topology_of(truth, {.radius = 0.2}), 4, 2, Starts::kApart, 2);
  ExecutionSettings s = settings(2);
  s.most_s = 1.0;
  EXPECT_EQ(execute(truth, mission, s).missed.size(), 4U);
}

}  // namespace
}  // namespace outrider::explorer
