#include "explorer/lower_bound.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "explorer/mission.hpp"
#include "explorer/scan_mapper.hpp"

namespace outrider::explorer {
namespace {

constexpr double kFractions[] = {0.5, 0.9, 0.95, 0.99};

OccupancyGrid open_field(int width, int height) {
  return OccupancyGrid({1.0, {0.0, 0.0}, width, height}, CellState::kFree);
}

RobotSpec robot_at(const OccupancyGrid& map, Cell c, double speed, double range) {
  const Point p = map.geometry().center(c);
  return {.name = fmt::format("r{}_{}", c.x, c.y),
          .start = {p.x, p.y, 0.0},
          .speed = speed,
          .range = range,
          .radius = 0.4 * map.geometry().resolution};
}

TEST(LowerBound, OfACorridorIsTheDriveToItsEnd) {
  const OccupancyGrid map = open_field(101, 1);
  const std::vector<RobotSpec> team{robot_at(map, {0, 0}, 2.0, 5.0)};
  const double bound = lower_bound_s(map, team, 1.0, false);
  EXPECT_LE(bound, 95.0 / 2.0);          // it sees the last cell from five cells away
  EXPECT_GE(bound, (95.0 - 2.0) / 2.0);  // all but the margin of two cells
}

TEST(LowerBound, OfAnOpenFieldIsNearlyAreaOverSweep) {
  const OccupancyGrid map = open_field(100, 100);
  const std::vector<RobotSpec> team{robot_at(map, {50, 50}, 3.0, 4.0), robot_at(map, {10, 50}, 3.0, 4.0)};
  const double bound = lower_bound_s(map, team, 1.0, false), rate = 2 * 3.0 * (2 * 4.0 + 1.0);
  EXPECT_LE(bound, 1e4 / rate);
  EXPECT_GE(bound, 0.97 * 1e4 / rate);
}

TEST(LowerBound, GrowsWithTheFractionAndShrinksWithTheTeam) {
  const OccupancyGrid map = open_field(60, 40);
  std::vector<RobotSpec> team{robot_at(map, {5, 5}, 1.0, 3.0)};
  double before = 0.0;
  for (const double fraction : kFractions) {
    EXPECT_GT(lower_bound_s(map, team, fraction, false), before);
    before = lower_bound_s(map, team, fraction, false);
  }
  team.push_back(robot_at(map, {50, 30}, 1.0, 3.0));
  EXPECT_LT(lower_bound_s(map, team, 0.99, false), before);
}

TEST(LowerBound, OfWhatIsSeenAtOnceIsZero) {
  const OccupancyGrid map = open_field(5, 5);
  EXPECT_EQ(lower_bound_s(map, {robot_at(map, {2, 2}, 1.0, 10.0)}, 0.99, false), 0.0);
}

// The law that makes it a bound: no run of any coordinator, with any sensor, is ever faster.
TEST(LowerBound, NoRunBeatsIt) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    std::mt19937_64 random(seed);
    const int size = 20 + static_cast<int>(random() % 20);
    OccupancyGrid map = open_field(size, size);
    for (std::size_t k = 0; k < map.size() * (seed % 4) / 20; ++k) map[random() % map.size()] = CellState::kOccupied;
    std::vector<RobotSpec> team;
    for (std::size_t r = 0; r < 1 + seed % 3; ++r) {
      const Cell c{static_cast<int>(random() % 6) * 3, static_cast<int>(r) * 4};
      map[c] = CellState::kFree;
      team.push_back(
          robot_at(map, c, 1.0 + static_cast<double>(random() % 4), 2.0 + static_cast<double>(random() % 7)));
      team.back().name += fmt::format("_{}", r);
    }
    for (const bool lidar : {false, true})
      for (const char* coordinator : {"daa", "nearest", "hungarian"}) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", " << coordinator << (lidar ? ", lidar" : ""));
        MissionSettings settings;
        settings.coordinator = coordinator;
        settings.sim.lidar = lidar;
        settings.make_mapper = make_scan_mapper;
        settings.record_events = false;
        const MissionResult result = run_mission(map, team, settings);
        for (const auto& [fraction, time] : result.time_to) {
          if (time) {
            EXPECT_GE(*time, lower_bound_s(map, team, fraction, lidar)) << fraction;
          }
        }
      }
  }
}

}  // namespace
}  // namespace outrider::explorer
