#include "decision/traffic.hpp"

#include <gtest/gtest.h>

#include <random>

#include "decision/passability.hpp"
#include "support/random_map.hpp"

namespace outrider::decision {
namespace {

// The detour is looked for in a window; on the whole map none is shorter.
TEST(Traffic, ADetourIsTheShortestWayOnTheWholeMapAroundThoseWhoStandThere) {
  constexpr double kRadius = 0.6;
  std::size_t found = 0, too_long = 0;
  for (std::uint64_t seed = 0; seed < 900; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const OccupancyGrid map = test::random_map(seed, 40, 0.5);
    const GridGeometry& g = map.geometry();
    const Grid<std::uint8_t> passable = passable_mask(map, 0.3);
    const auto somewhere = [&] { return g.cell_at(random() % g.size()); };
    std::vector<Neighbour> neighbours(2);
    Grid<std::uint8_t> free = passable;
    for (Neighbour& n : neighbours) {
      n.position = g.center(somewhere());
      n.radius = 0.5;
      for (std::size_t i = 0; i < g.size(); ++i)
        if (distance(g.center(g.cell_at(i)), n.position) < kRadius + n.radius - 1e-6) free[i] = 0;
    }
    const Cell from = somewhere(), to = somewhere();
    const double longest = 2.0 + static_cast<double>(random() % 20);
    free[from] = 1;
    DistanceField field;
    const Cell source[] = {to};
    if (free[to]) field.compute(free, source);
    const bool expected = free[to] && field.reached(from) && field.metres(from) <= longest;
    const auto way = Traffic(g, kRadius).detour(passable, from, to, longest, neighbours);
    ASSERT_EQ(way.has_value(), expected);
    if (free[to] && field.reached(from) && !expected) ++too_long;
    if (!way) continue;
    ++found;
    EXPECT_EQ(*way, field.path(from));
  }
  EXPECT_GT(found, 30U);
  EXPECT_GT(too_long, 5U);
}

}  // namespace
}  // namespace outrider::decision
