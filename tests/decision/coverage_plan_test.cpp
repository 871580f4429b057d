#include "decision/coverage_plan.hpp"

#include <gtest/gtest.h>

#include <bit>

#include "decision/passability.hpp"
#include "support/random_map.hpp"
#include "world/ray.hpp"

namespace outrider::decision {
namespace {

/// The slow oracle: relaxation over all neighbours that are linked by a leg of one step, until nothing changes.
std::vector<int> relaxed_fifths(CoverageGround& ground, CoverageGround::Node from) {
  std::vector<int> fifths(ground.nodes(), 1 << 20);
  fifths[from] = 0;
  const GridGeometry& g = ground.geometry();
  for (bool news = true; news;) {
    news = false;
    for (CoverageGround::Node a = 0; a < ground.nodes(); ++a)
      for (int d = 0; d < 9; ++d) {
        const Cell c = g.cell_at(a), n{c.x + d % 3 - 1, c.y + d / 3 - 1};
        if (d == 4 || !g.contains(n)) continue;
        const auto b = static_cast<CoverageGround::Node>(g.index(n));
        if (ground.leg(a, b).nodes.size() != 1) continue;
        const int there = fifths[a] + (c.x != n.x && c.y != n.y ? 7 : 5);
        if (there < fifths[b]) fifths[b] = there, news = true;
      }
  }
  return fifths;
}

TEST(CoverageGround, LegsAreShortestWaysOverNeighbours) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const OccupancyGrid map = test::random_map(seed, 24, 0.25);
    const Grid<std::uint8_t> free = test::free_cells(map);
    for (const int block : {1, 2, 3}) {
      CoverageGround ground(map, free, free, block);
      const auto from = static_cast<CoverageGround::Node>(seed * 37 % ground.nodes());
      const std::vector<int> expected = relaxed_fifths(ground, from);
      for (CoverageGround::Node to = 0; to < ground.nodes(); ++to) {
        const CoverageGround::Leg& leg = ground.leg(from, to);
        ASSERT_EQ(leg.exists, expected[to] < 1 << 20) << "to " << to;
        int fifths = 0;
        for (CoverageGround::Node here = from; const CoverageGround::Node node : leg.nodes) {
          fifths += ground.step_m(here, node) > 1.1 * ground.geometry().resolution ? 7 : 5;
          here = node;
        }
        if (leg.exists) {
          ASSERT_EQ(fifths, expected[to]) << "to " << to;
        }
      }
    }
  }
}

/// But for lines through corners, where a ray is stopped by one cell beside it.
TEST(CoverageGround, BlocksOfOneCellSeeWhatIsInLineOfSight) {
  int in_sight = 0, in_view = 0;
  const double range = 4.2;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(seed);
    const OccupancyGrid map = test::random_map(seed, 20, 0.2);
    const GridGeometry& g = map.geometry();
    const Grid<std::uint8_t> free = test::free_cells(map);
    CoverageGround ground(map, free, free, 1);
    for (std::size_t i = 0; i < map.size(); ++i) {
      if (!free[i]) continue;
      std::vector<std::uint8_t> seen(map.size(), 0);
      for (const auto& word : ground.view(static_cast<CoverageGround::Node>(i), range))
        for (std::uint64_t bits = word.bits; bits != 0; bits &= bits - 1)
          seen[word.index * 64 + static_cast<std::size_t>(std::countr_zero(bits))] = 1;
      for (std::size_t k = 0; k < map.size(); ++k) {
        const Cell a = g.cell_at(i), b = g.cell_at(k);
        if (map[b] != CellState::kFree) continue;
        const bool near = distance(g.center(a), g.center(b)) <= range;
        const bool sight = near && (a == b || line_of_sight(map, a, b));
        ASSERT_LE(seen[k] != 0, sight) << i << " sees " << k;
        in_sight += sight;
        in_view += seen[k];
      }
    }
  }
  EXPECT_GT(in_view, 0.95 * in_sight);
}

TEST(CoveragePlanner, SeesAnOpenFieldNearlyAsFastAsSweepingWould) {
  const OccupancyGrid map({1.0, {0.0, 0.0}, 40, 40}, CellState::kFree);
  const Grid<std::uint8_t> all(map.geometry(), 1);
  CoverageGround ground(map, all, all, 2);
  const std::vector<CoverageRobot> team{{0, 2.0, 5.0}, {ground.node_of({39, 39}), 1.0, 4.0}};
  const double swept_s = 1600.0 / (2.0 * 2.0 * 5.0 + 2.0 * 1.0 * 4.0);
  const auto plan = [&] {
    std::mt19937_64 random(7);
    return CoveragePlanner(ground, team, {}).improve(CoverageTours(2), 6000, random);
  };
  const CoverageTours tours = plan();
  const double cost = CoveragePlanner(ground, team, {}).cost(tours);
  EXPECT_LT(cost, 1.7 * swept_s);
  EXPECT_LT(cost, CoveragePlanner(ground, team, {}).cost(CoverageTours(2)));
  EXPECT_EQ(tours, plan());  // deterministic
}

TEST(CoveragePlanner, NothingToSeeChangesNothing) {
  const OccupancyGrid map({1.0, {0.0, 0.0}, 8, 8}, CellState::kFree);
  CoverageGround ground(map, Grid<std::uint8_t>(map.geometry(), 1), Grid<std::uint8_t>(map.geometry()), 2);
  std::mt19937_64 random(1);
  CoveragePlanner planner(ground, {{0, 1.0, 2.0}}, {});
  EXPECT_EQ(planner.improve({{3, 5}}, 50, random), (CoverageTours{{3, 5}}));
}

}  // namespace
}  // namespace outrider::decision
