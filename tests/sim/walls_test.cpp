#include "sim/walls.hpp"

#include <gtest/gtest.h>

#include "random_world.hpp"
#include "support/ascii.hpp"

namespace outrider::sim {
namespace {

TEST(Walls, PassableCellsAreThoseWithRoomForTheDisc) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const double resolution = uniform(random, 0.05, 1.0), radius = uniform(random, 0.01, 3.0 * resolution);
    const OccupancyGrid map = random_map(30, 20, resolution, 0.08, random);
    const Walls walls(map, radius);
    for (std::size_t i = 0; i < map.size(); ++i) {
      const Cell c = map.geometry().cell_at(i);
      const double room = map[i] == CellState::kFree ? clearance_by_search(map, map.geometry().center(c)) : 0.0;
      EXPECT_EQ(walls.passable(c), room >= radius) << c.x << ' ' << c.y << " room " << room << " radius " << radius;
    }
    EXPECT_FALSE(walls.passable({-1, 5}));
    EXPECT_FALSE(walls.passable({30, 5}));
  }
}

TEST(Walls, FitsAgreesWithSearch) {
  std::mt19937_64 random(7);
  const OccupancyGrid map = random_map(30, 20, 0.25, 0.05, random);
  for (const double radius : {0.01, 0.2, 0.25, 0.6}) {
    const Walls walls(map, radius);
    for (int i = 0; i < 2000; ++i) {
      const Point p{uniform(random, -2.0, 6.5), uniform(random, 2.0, 7.5)};
      EXPECT_EQ(walls.fits(p), clearance_by_search(map, p) >= radius - kTouchTolerance) << p.x << ' ' << p.y;
    }
  }
}

/// Up to where the search finds room, by small steps: the way is free to `free_length` and not much farther.
void expect_exact(const OccupancyGrid& map, const Walls& walls, Point from, Point to) {
  const double length = distance(from, to), free = walls.free_length(from, to);
  ASSERT_LE(free, length + 1e-12);
  const auto at = [&](double s) {
    return Point{from.x + (to.x - from.x) * s / length, from.y + (to.y - from.y) * s / length};
  };
  for (int i = 0; i <= 200; ++i)
    ASSERT_GE(clearance_by_search(map, at(free * i / 200)), walls.radius() - kTouchTolerance) << free * i / 200;
  if (free < length) {
    EXPECT_NEAR(clearance_by_search(map, at(free)), walls.radius(), 1e-8);
    // A little farther the disc is in the wall, unless the way only grazes a corner.
    EXPECT_LT(clearance_by_search(map, at(free + 1e-6)), walls.radius());
  }
}

TEST(Walls, FreeLengthEndsAtContact) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const double radius = uniform(random, 0.02, 0.7);
    const OccupancyGrid map = random_map(30, 20, 0.25, 0.04, random);
    const Walls walls(map, radius);
    for (int i = 0, tried = 0; i < 2000 && tried < 60; ++i) {
      const Point from{uniform(random, -1.5, 6.0), uniform(random, 2.25, 7.25)};
      if (!walls.fits(from)) continue;
      ++tried;
      expect_exact(map, walls, from, {uniform(random, -3.0, 8.0), uniform(random, 0.0, 9.0)});
    }
  }
}

TEST(Walls, NeighbourStepsAreFreeAsTheExactCheckFindsThem) {
  std::mt19937_64 random(3);
  const OccupancyGrid map = random_map(40, 40, 0.25, 0.06, random);
  const GridGeometry& g = map.geometry();
  for (const double radius : {0.125, 0.2, 0.3, 0.55}) {
    const Walls walls(map, radius);
    for (std::size_t i = 0; i < map.size(); ++i) {
      const Cell a = g.cell_at(i);
      for (const Cell step : {Cell{1, 0}, Cell{1, 1}, Cell{0, 1}, Cell{-1, 1}}) {
        const Cell b{a.x + step.x, a.y + step.y};
        if (!walls.passable(a) || !walls.passable(b) || !walls.passable({a.x, b.y}) || !walls.passable({b.x, a.y}))
          continue;
        for (int k = 0; k <= 10; ++k) {
          const Point p{g.center(a).x + 0.025 * k * step.x, g.center(a).y + 0.025 * k * step.y};
          ASSERT_TRUE(walls.fits(p)) << a.x << ' ' << a.y << ' ' << step.x << ' ' << step.y;
        }
      }
    }
  }
}

TEST(Walls, TouchingIsLegalAndSlidingAlongAWallToo) {
  const OccupancyGrid corridor = test::grid_from_ascii(R"(
    ##########
    ..........
    ##########)");
  const Walls walls(corridor, 0.5);
  EXPECT_TRUE(walls.passable({3, 1}));
  EXPECT_DOUBLE_EQ(walls.free_length({0.5, 1.5}, {9.5, 1.5}), 9.0);
  EXPECT_NEAR(walls.free_length({0.5, 1.5}, {12.5, 1.5}), 9.0, 1e-8);  // the edge of the map is solid
  EXPECT_FALSE(Walls(corridor, 0.51).passable({3, 1}));
}

TEST(Walls, ABodyPressedAgainstAWallMayLeaveButNotGoOn) {
  const OccupancyGrid map = test::grid_from_ascii(R"(
    ....
    ...#
    ....)");
  const Walls walls(map, 0.4);
  const Point pressed{2.6 + 0.7e-9, 1.5};  // within the tolerance
  ASSERT_TRUE(walls.fits(pressed));
  EXPECT_EQ(walls.free_length(pressed, {2.9, 1.5}), 0.0);
  EXPECT_DOUBLE_EQ(walls.free_length(pressed, {0.6 + 0.7e-9, 1.5}), 2.0);
  EXPECT_NEAR(walls.free_length(pressed, {2.6 + 0.7e-9, 2.5}), 1.0, 1e-12);  // along it
}

TEST(Walls, DiagonalGapBetweenWallsIsClosed) {
  const OccupancyGrid map = test::grid_from_ascii(R"(
    #.
    .#)");
  EXPECT_LT(Walls(map, 1e-3).free_length({0.5, 0.5}, {1.5, 1.5}), 0.71);
}

TEST(Walls, UnknownIsSolid) {
  const OccupancyGrid map = test::grid_from_ascii("...?");
  const Walls walls(map, 0.25);
  EXPECT_FALSE(walls.passable({3, 0}));
  EXPECT_NEAR(walls.free_length({0.5, 0.5}, {3.5, 0.5}), 2.25, 1e-8);
}

}  // namespace
}  // namespace outrider::sim
