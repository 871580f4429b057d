#include "explorer/referee.hpp"

#include <gtest/gtest.h>

#include <random>

#include "decision/distance_field.hpp"
#include "decision/passability.hpp"
#include "support/random_map.hpp"

namespace outrider::explorer {
namespace {

// All that the discs around all reached cells cover, not only those at the edge.
TEST(Referee, WhatIsReachableIsWhatTheBodySweeps) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const OccupancyGrid truth = solid_map(test::random_map(seed, 30, 0.25));
    const GridGeometry& g = truth.geometry();
    RobotSpec robot;
    robot.radius = 0.1 + 0.05 * static_cast<double>(random() % 16);
    const Cell start = g.cell_at(random() % g.size());
    robot.start = {g.center(start).x, g.center(start).y, 0.0};
    decision::DistanceField field;
    const Cell source[] = {start};
    field.compute(decision::passable_mask(truth, robot.radius), source);
    const Grid<std::uint8_t> reachable = reachable_area(truth, {robot});
    for (std::size_t i = 0; i < g.size(); ++i) {
      bool swept = false;
      for (std::size_t k = 0; k < g.size() && truth[i] == CellState::kFree; ++k) {
        const Cell a = g.cell_at(i), b = g.cell_at(k);
        swept = swept || (field.reached(b) && std::hypot(a.x - b.x, a.y - b.y) * g.resolution <= robot.radius);
      }
      ASSERT_EQ(reachable[i] != 0, swept) << i;
    }
  }
}

}  // namespace
}  // namespace outrider::explorer
