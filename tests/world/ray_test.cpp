#include "world/ray.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <vector>

#include "support/ascii.hpp"
#include "support/random_map.hpp"

namespace outrider {
namespace {

constexpr double kNear = 1e-9;  // [m] what passes a square at less than this may count as touching it or not

/// The part of a ray that lies in the square of a cell, grown by `margin` on all sides [m].
struct Chord {
  double in = 0.0, out = -1.0;
  bool exists() const { return out >= in; }
};
Chord chord(const GridGeometry& g, Cell c, Point from, double dx, double dy, double range, double margin) {
  long double in = 0.0L, out = range;
  const auto clip = [&](long double low, long double at, long double d) {
    const long double high = low + g.resolution + margin;
    low -= margin;
    if (d == 0.0L) {
      if (at < low || at > high) out = -1.0L;
      return;
    }
    in = std::max(in, std::min((low - at) / d, (high - at) / d));
    out = std::min(out, std::max((low - at) / d, (high - at) / d));
  };
  clip(g.origin.x + static_cast<long double>(c.x) * g.resolution, from.x, dx);
  clip(g.origin.y + static_cast<long double>(c.y) * g.resolution, from.y, dy);
  return {static_cast<double>(in), static_cast<double>(out)};
}

struct Ray {
  Point from;
  double angle, range;
};

double unit(std::mt19937_64& random) { return static_cast<double>(random() >> 11) * 0x1p-53; }

/// A ray that passes no corner nearly: in general position.
Ray general_ray(std::mt19937_64& random, const GridGeometry& g) {
  Ray ray;
  ray.from.x = g.origin.x + unit(random) * g.width * g.resolution;
  ray.from.y = g.origin.y + unit(random) * g.height * g.resolution;
  ray.angle = (unit(random) * 2.0 - 1.0) * kPi;
  ray.range = random() % 4 == 0 ? 1e6 : unit(random) * 1.5 * g.width * g.resolution;
  return ray;
}

/// A ray of any kind: also from edges and corners, along axes and diagonals.
Ray any_ray(std::mt19937_64& random, const GridGeometry& g) {
  Ray ray = general_ray(random, g);
  const auto onto_edge = [&](double& at, double origin) {
    if (random() % 3 == 0) at = origin + std::floor((at - origin) / g.resolution * 2.0) / 2.0 * g.resolution;
  };
  onto_edge(ray.from.x, g.origin.x);
  onto_edge(ray.from.y, g.origin.y);
  if (random() % 3 == 0) ray.angle = static_cast<double>(random() % 17) * kPi / 8.0 - kPi;
  return ray;
}

TEST(WalkRay, VisitsWhatItCrossesInOrder) {
  std::mt19937_64 random(11);
  for (int trial = 0; trial < 1500; ++trial) {
    SCOPED_TRACE(trial);
    const GridGeometry g{trial % 2 == 0 ? 1.0 : 0.05,
                         {-1.7, 3.1},
                         1 + static_cast<int>(random() % 25),
                         1 + static_cast<int>(random() % 25)};
    const Ray ray = any_ray(random, g);
    const double dx = std::cos(ray.angle), dy = std::sin(ray.angle);
    Grid<int> visited(g);
    Cell before{};
    double entered = 0.0;
    int count = 0;
    walk_ray(g, ray.from, dx, dy, ray.range, [&](Cell c, double t) {
      EXPECT_EQ(visited[c]++, 0);
      EXPECT_TRUE(count++ == 0 || std::abs(c.x - before.x) + std::abs(c.y - before.y) == 1);
      const Chord grown = chord(g, c, ray.from, dx, dy, ray.range, kNear);
      const Chord shrunk = chord(g, c, ray.from, dx, dy, ray.range, -kNear);
      EXPECT_TRUE(grown.exists());
      EXPECT_GE(t, grown.in - kNear);
      if (shrunk.exists()) {
        EXPECT_LE(t, shrunk.in + kNear);
      }
      EXPECT_GE(t, entered - kNear);
      before = c;
      entered = t;
      return true;
    });
    for (std::size_t i = 0; i < visited.size(); ++i) {
      if (!chord(g, g.cell_at(i), ray.from, dx, dy, ray.range, -kNear).exists()) continue;
      EXPECT_EQ(visited[i], 1);
    }
    if (testing::Test::HasFailure()) return;
  }
}

std::string order_of_visits(Point from, double dx, double dy) {
  const GridGeometry g{1.0, {}, 3, 3};
  Grid<char> drawn(g, '.');
  char next = '1';
  walk_ray(g, from, dx, dy, 100.0, [&](Cell c, double) {
    drawn[c] = next++;
    return true;
  });
  return test::draw(g, [&](Cell c) { return drawn[c]; });
}

TEST(WalkRay, ThroughCornersTheNeighbourInXComesFirst) {
  const double d = std::sqrt(0.5);
  EXPECT_EQ(order_of_visits({0.5, 0.5}, d, d), "..5\n.34\n12.\n");
  EXPECT_EQ(order_of_visits({2.5, 2.5}, -d, -d), ".21\n43.\n5..\n");
  EXPECT_EQ(order_of_visits({0.5, 2.5}, d, -d), "12.\n.34\n..5\n");
  EXPECT_EQ(order_of_visits({2.5, 0.5}, -d, d), "5..\n43.\n.21\n");
}

TEST(WalkRay, AxisParallelAndOutside) {
  EXPECT_EQ(order_of_visits({0.5, 1.5}, 1.0, 0.0), "...\n123\n...\n");
  EXPECT_EQ(order_of_visits({1.5, 2.5}, 0.0, -1.0), ".1.\n.2.\n.3.\n");
  EXPECT_EQ(order_of_visits({1.0, 1.0}, -1.0, 0.0), "...\n21.\n...\n");  // from an edge: its cell is the upper one
  EXPECT_EQ(order_of_visits({-0.5, 1.5}, 1.0, 0.0), "...\n...\n...\n");
}

TEST(CastRay, HitsTheFirstOccupiedSquare) {
  int hits = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    const OccupancyGrid map = test::random_map(seed, 40, seed % 2 == 0 ? 1.0 : 0.05);
    const GridGeometry& g = map.geometry();
    std::mt19937_64 random(seed);
    for (int i = 0; i < 12; ++i) {
      SCOPED_TRACE(i);
      const Ray ray = any_ray(random, g);
      const double dx = std::cos(ray.angle), dy = std::sin(ray.angle);
      // Whatever is crossed must be hit; a corner that is only touched may be.
      double must = 1e9, may = 1e9;
      for (std::size_t k = 0; k < map.size(); ++k) {
        if (map[k] != CellState::kOccupied) continue;
        const Chord grown = chord(g, g.cell_at(k), ray.from, dx, dy, ray.range, kNear);
        const Chord shrunk = chord(g, g.cell_at(k), ray.from, dx, dy, ray.range, -kNear);
        if (grown.exists()) may = std::min(may, grown.in);
        if (shrunk.exists()) must = std::min(must, shrunk.in);
      }
      const double hit = cast_ray(map, ray.from, ray.angle, ray.range).value_or(1e9);
      EXPECT_GE(hit, may - kNear);
      EXPECT_LE(hit, must + kNear);
      hits += hit < 1e9;
    }
    if (testing::Test::HasFailure()) return;
  }
  EXPECT_GT(hits, 500);
}

TEST(CastRay, IsExactInLargeMaps) {
  // Far enough for errors to add up, and fine posts to miss.
  OccupancyGrid map(GridGeometry{0.05, {-40.0, 12.3}, 1500, 1300}, CellState::kFree);
  std::mt19937_64 random(5);
  for (int i = 0; i < 4000; ++i) map[random() % map.size()] = CellState::kOccupied;
  for (int i = 0; i < 4000; ++i) {
    SCOPED_TRACE(i);
    const Ray ray = general_ray(random, map.geometry());
    std::optional<double> expected;
    walk_ray(map.geometry(), ray.from, std::cos(ray.angle), std::sin(ray.angle), ray.range, [&](Cell c, double t) {
      if (map[c] != CellState::kOccupied) return true;
      expected = t;
      return false;
    });
    const auto hit = cast_ray(map, ray.from, ray.angle, ray.range);
    ASSERT_EQ(hit.has_value(), expected.has_value());
    ASSERT_NEAR(hit.value_or(0.0), expected.value_or(0.0), kNear);
  }
}

TEST(CastRay, NeverLeaksThroughDiagonalWalls) {
  const auto* text = R"(
    .....#.....
    ....#.#....
    ...#...#...
    ..#.....#..
    .#...a...#.
    ..#.....#..
    ...#...#...
    ....#.#....
    .....#.....)";
  const OccupancyGrid map = test::grid_from_ascii(text, 0.1);
  const Point center = map.geometry().center(test::cell_marked(text, 'a'));
  for (const double off : {0.0, 0.05, -0.05, 0.013})
    for (int i = 0; i < 7200; ++i)
      ASSERT_TRUE(cast_ray(map, {center.x + off, center.y + off}, i * kPi / 3600.0, 10.0)) << off << ' ' << i;
}

TEST(CastRay, BordersAndRange) {
  const OccupancyGrid map = test::grid_from_ascii("...#", 0.5);
  EXPECT_DOUBLE_EQ(cast_ray(map, {0.25, 0.25}, 0.0, 10.0).value(), 1.25);
  EXPECT_DOUBLE_EQ(cast_ray(map, {0.25, 0.25}, 0.0, 1.25).value(), 1.25);  // the range counts as within
  EXPECT_FALSE(cast_ray(map, {0.25, 0.25}, 0.0, 1.249));
  EXPECT_FALSE(cast_ray(map, {0.25, 0.25}, kPi, 10.0));           // leaves the map
  EXPECT_FALSE(cast_ray(map, {-0.25, 0.25}, 0.0, 10.0));          // begins outside
  EXPECT_EQ(cast_ray(map, {1.75, 0.25}, 1.0, 1.0), 0.0);          // begins inside a wall
  EXPECT_EQ(cast_ray(map, {1.0, 0.0}, kPi, 10.0), std::nullopt);  // sin(pi) is not 0: along the lower border
  EXPECT_FALSE(cast_ray(OccupancyGrid{}, {0.0, 0.0}, 0.0, 1.0));
}

TEST(CastScan, IsOneCastABeam) {
  const OccupancyGrid map = test::random_map(21, 40, 0.05);
  const Point from = map.geometry().center({map.width() / 2, map.height() / 2});
  std::vector<float> ranges(97);
  cast_scan(map, from, -1.0, 0.05, ranges, 1.5);
  for (std::size_t i = 0; i < ranges.size(); ++i)
    EXPECT_EQ(ranges[i],
              static_cast<float>(cast_ray(map, from, -1.0 + static_cast<double>(i) * 0.05, 1.5).value_or(1.5)));
}

/// Squares crossed, and pairs of squares passed between, from the slabs of every cell.
bool oracle_sight(const OccupancyGrid& map, Cell a, Cell b) {
  const GridGeometry& g = map.geometry();
  const Point pa = g.center(a), pb = g.center(b);
  const double d = distance(pa, pb);
  if (d == 0.0) return map[a] != CellState::kOccupied;
  for (std::size_t i = 0; i < map.size(); ++i)
    if (map[i] == CellState::kOccupied &&
        chord(g, g.cell_at(i), pa, (pb.x - pa.x) / d, (pb.y - pa.y) / d, d, -kNear).exists())
      return false;
  const auto occupied = [&](int x, int y) { return map.contains({x, y}) && map[Cell{x, y}] == CellState::kOccupied; };
  // Corners (x, y) between the cells (x - 1, y - 1) and (x, y), exactly on the segment in half cells.
  for (int y = std::min(a.y, b.y) + 1; y <= std::max(a.y, b.y); ++y)
    for (int x = std::min(a.x, b.x) + 1; x <= std::max(a.x, b.x); ++x) {
      if ((2 * x - 2 * a.x - 1) * (b.y - a.y) != (2 * y - 2 * a.y - 1) * (b.x - a.x)) continue;
      const bool rising = (b.x > a.x) == (b.y > a.y);
      if (rising ? occupied(x - 1, y) && occupied(x, y - 1) : occupied(x - 1, y - 1) && occupied(x, y)) return false;
    }
  return true;
}

TEST(LineOfSight, EqualsOracleFromBothEnds) {
  int clear = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SCOPED_TRACE(seed);
    const OccupancyGrid map = test::random_map(seed, 14);
    std::mt19937_64 random(seed);
    for (int i = 0; i < 30; ++i) {
      const Cell a = map.geometry().cell_at(random() % map.size()), b = map.geometry().cell_at(random() % map.size());
      const bool expected = oracle_sight(map, a, b);
      ASSERT_EQ(line_of_sight(map, a, b), expected) << a.x << ',' << a.y << " to " << b.x << ',' << b.y;
      ASSERT_EQ(line_of_sight(map, b, a), expected);
      clear += expected;
    }
  }
  EXPECT_GT(clear, 500);
}

TEST(LineOfSight, DiagonalWallsAreClosed) {
  EXPECT_FALSE(line_of_sight(test::grid_from_ascii("#.\n.#"), {0, 0}, {1, 1}));
  EXPECT_TRUE(line_of_sight(test::grid_from_ascii("#.\n.."), {0, 0}, {1, 1}));
  EXPECT_FALSE(line_of_sight(test::grid_from_ascii("..\n#."), {0, 0}, {1, 1}));  // from within a wall
}

}  // namespace
}  // namespace outrider
