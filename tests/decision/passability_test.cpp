#include "decision/passability.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "support/ascii.hpp"
#include "support/random_map.hpp"
#include "world/error.hpp"

namespace outrider::decision {
namespace {

/// Distance [m] from a point to the edge of the map or the nearest occupied square, by looking at all of them.
double clearance(const OccupancyGrid& map, Point p) {
  const GridGeometry& g = map.geometry();
  const Point high{g.origin.x + g.width * g.resolution, g.origin.y + g.height * g.resolution};
  double nearest = std::min({p.x - g.origin.x, p.y - g.origin.y, high.x - p.x, high.y - p.y});
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] != CellState::kOccupied) continue;
    const Point center = g.center(g.cell_at(i));
    const double dx = std::max(0.0, std::abs(p.x - center.x) - g.resolution / 2);
    const double dy = std::max(0.0, std::abs(p.y - center.y) - g.resolution / 2);
    nearest = std::min(nearest, std::hypot(dx, dy));
  }
  return nearest;
}

Grid<std::uint8_t> oracle_mask(const OccupancyGrid& map, double radius) {
  Grid<std::uint8_t> mask(map.geometry());
  for (std::size_t i = 0; i < map.size(); ++i)
    mask[i] = map[i] == CellState::kFree &&
              clearance(map, map.geometry().center(map.geometry().cell_at(i))) >= radius * (1.0 - 1e-9);
  return mask;
}

std::vector<std::uint32_t> all_cells(const OccupancyGrid& map) {
  std::vector<std::uint32_t> cells(map.size());
  std::iota(cells.begin(), cells.end(), 0U);
  return cells;
}

std::string draw(const Grid<std::uint8_t>& mask) {
  return test::draw(mask.geometry(), [&](Cell c) { return mask[c] ? '.' : '#'; });
}

double radius_for(std::uint64_t seed, double resolution) {
  return std::vector{0.0, 0.4, 0.5, 0.7071, 1.0, 1.5, 2.0, 2.5, 3.3}[seed % 9] * resolution;
}

TEST(Passability, EqualsBruteForceOnRandomMaps) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const double resolution = seed % 2 == 0 ? 1.0 : 0.05;
    const OccupancyGrid map = test::random_map(seed, 24, resolution);
    const double radius = radius_for(seed, resolution);
    const Grid<std::uint8_t> expected = oracle_mask(map, radius);
    ASSERT_EQ(draw(passable_mask(map, radius)), draw(expected));
    Passability passability(map.geometry(), radius);
    EXPECT_EQ(std::accumulate(passability.mask().data().begin(), passability.mask().data().end(), 0), 0);
    passability.update(map, all_cells(map));
    ASSERT_EQ(draw(passability.mask()), draw(expected));
  }
}

TEST(Passability, FollowsChangesInAnyOrder) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    OccupancyGrid map = test::random_map(seed, 24);
    std::mt19937_64 random(seed);
    Passability passability(map.geometry(), radius_for(seed, 1.0));
    passability.update(map, all_cells(map));
    for (int round = 0; round < 10; ++round) {
      std::vector<std::uint32_t> changed;
      for (int i = 0; i < 15; ++i) {
        changed.push_back(static_cast<std::uint32_t>(random() % map.size()));
        map[changed.back()] = static_cast<CellState>(random() % 3);  // some stay as they are, some come twice
      }
      passability.update(map, changed);
      ASSERT_EQ(draw(passability.mask()), draw(passable_mask(map, passability.radius()))) << "round " << round;
    }
  }
}

/// The middle row of the mask of a map of nine rows like this one.
std::string middle_of_nine(const std::string& row, double resolution, double radius) {
  std::string rows;
  for (int k = 0; k < 9; ++k) rows += row + '\n';
  const std::string drawn = draw(passable_mask(test::grid_from_ascii(rows, resolution), radius));
  return drawn.substr(4 * (row.size() + 1), row.size());
}

TEST(Passability, TouchingIsAllowed) {
  // The centre of cell x is (x - 0.5) cells from the square: a radius of 1.5 cells touches at x = 2.
  EXPECT_EQ(middle_of_nine("#......", 0.1, 0.15), "##....#");  // 2 * 0.15 / 0.1 is not 3 in doubles
  EXPECT_EQ(middle_of_nine("#......", 0.1, 0.1501), "###..##");
  EXPECT_EQ(middle_of_nine("#......", 0.1, 0.0), "#......");
  EXPECT_EQ(middle_of_nine("#......", 0.1, 0.05), "#......");
}

TEST(Passability, UnknownIsClosedButDoesNotInflate) { EXPECT_EQ(middle_of_nine("..?..#..", 1.0, 1.0), "#.#.####"); }

TEST(Passability, RefusesImpossibleRadii) {
  const GridGeometry g{0.05, {}, 4, 4};
  EXPECT_THROW(Passability(g, -0.1), InputError);
  EXPECT_THROW(Passability(g, std::nan("")), InputError);
  EXPECT_THROW(Passability(g, 7.0), InputError);
  EXPECT_NO_THROW(Passability(g, 3.2));
}

TEST(Passability, AllowedStepsNeverTouchAnObstacle) {
  int steps = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const OccupancyGrid map = test::random_map(seed, 16);
    const double radius = radius_for(seed, 1.0);
    const Grid<std::uint8_t> mask = passable_mask(map, radius);
    for (std::size_t i = 0; i < map.size(); ++i)
      for (const Cell d : {Cell{1, 0}, Cell{0, 1}, Cell{1, 1}, Cell{-1, 1}}) {
        const Cell from = map.geometry().cell_at(i), to{from.x + d.x, from.y + d.y};
        ASSERT_EQ(step_allowed(mask, from, to), step_allowed(mask, to, from));
        if (!step_allowed(mask, from, to)) continue;
        ++steps;
        const Point a = map.geometry().center(from);
        for (double f = 0.0; f <= 1.0; f += 0.05)
          ASSERT_GE(clearance(map, {a.x + f * d.x, a.y + f * d.y}), radius * (1.0 - 1e-9));
      }
  }
  EXPECT_GT(steps, 1000);
}

TEST(Passability, DiagonalStepsDoNotCutCorners) {
  const auto mask = passable_mask(test::grid_from_ascii("..\n#."), 0.0);
  EXPECT_FALSE(step_allowed(mask, {1, 0}, {0, 1}));
  EXPECT_TRUE(step_allowed(mask, {1, 0}, {1, 1}));
  EXPECT_FALSE(step_allowed(mask, {1, 1}, {2, 1}));  // off the map
}

TEST(NearestPassable, EqualsBruteForce) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    const OccupancyGrid map = test::random_map(seed, 20);
    const auto mask = passable_mask(map, 1.0);
    const int max_cells = static_cast<int>(seed % 13);
    const Cell c{static_cast<int>(seed % 23) - 1, static_cast<int>(seed % 19) - 1};
    std::optional<Cell> expected;
    int best = max_cells * max_cells + 1;
    for (std::size_t i = 0; i < mask.size(); ++i) {
      const Cell n = mask.geometry().cell_at(i);
      const int squared = (n.x - c.x) * (n.x - c.x) + (n.y - c.y) * (n.y - c.y);
      if (mask[i] == 0 || squared >= best) continue;
      best = squared;
      expected = n;
    }
    EXPECT_EQ(nearest_passable(mask, c, max_cells), expected);
  }
}

}  // namespace
}  // namespace outrider::decision
