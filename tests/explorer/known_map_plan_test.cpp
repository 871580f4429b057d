#include "explorer/known_map_plan.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "explorer/lower_bound.hpp"

namespace outrider::explorer {
namespace {

RobotSpec robot_at(const OccupancyGrid& map, Cell c, double speed, double range) {
  const Point p = map.geometry().center(c);
  return {.name = fmt::format("r{}", c.x), .start = {p.x, p.y, 0.0}, .speed = speed, .range = range, .radius = 0.4};
}

TEST(KnownMapPlan, DrivesACorridorToItsEnd) {
  const OccupancyGrid map({1.0, {0.0, 0.0}, 61, 1}, CellState::kFree);
  const std::vector<RobotSpec> team{robot_at(map, {0, 0}, 2.0, 5.0)};
  const KnownMapPlan plan = plan_with_known_map(map, team, {.fraction = 1.0, .evaluations = 200});
  ASSERT_TRUE(plan.time_s.has_value());
  EXPECT_DOUBLE_EQ(*plan.time_s, 55.0 / 2.0);  // the last cell is in view five cells before it
}

TEST(KnownMapPlan, SearchImprovesOnItsBeginningAndStaysAboveTheBound) {
  OccupancyGrid map({1.0, {0.0, 0.0}, 50, 40}, CellState::kFree);
  for (int y = 0; y < 30; ++y) map[Cell{25, y}] = CellState::kOccupied;
  const std::vector<RobotSpec> team{robot_at(map, {5, 5}, 2.0, 4.0), robot_at(map, {7, 5}, 1.0, 3.0)};
  const auto time = [&](int evaluations) {
    return plan_with_known_map(map, team, {.evaluations = evaluations}).time_s.value();
  };
  const double begun = time(0), searched = time(4000);
  EXPECT_LT(searched, begun);
  EXPECT_GE(searched, lower_bound_s(map, team, 0.95, false));
  EXPECT_EQ(searched, time(4000));  // deterministic
}

TEST(KnownMapPlan, OfWhatIsSeenAtOnceIsDone) {
  const OccupancyGrid map({1.0, {0.0, 0.0}, 4, 4}, CellState::kFree);
  EXPECT_EQ(plan_with_known_map(map, {robot_at(map, {1, 1}, 1.0, 9.0)}, {.evaluations = 10}).time_s, 0.0);
}

}  // namespace
}  // namespace outrider::explorer
