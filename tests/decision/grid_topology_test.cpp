// Topological maps from grids: the graph of places drawn in ASCII, and laws on random maps.

#include "decision/grid_topology.hpp"

#include <gtest/gtest.h>

#include <set>

#include "decision/passability.hpp"
#include "decision/swept_disc.hpp"
#include "support/ascii.hpp"
#include "support/random_map.hpp"
#include "world/error.hpp"

namespace outrider::decision {
namespace {

int count(const TopologicalMap& map, SemanticState state) {
  return static_cast<int>(std::count_if(map.waypoints.begin(), map.waypoints.end(), [&](const Waypoint& w) { return w.state == state; }));
}

/// Each row character becomes scale x scale cells of 0.1 m.
OccupancyGrid scaled(const std::vector<std::string>& rows, int scale) {
  const int height = static_cast<int>(rows.size()), width = static_cast<int>(rows[0].size());
  OccupancyGrid map({0.1, {-1.0, 2.0}, width * scale, height * scale}, CellState::kFree);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      const char c = rows[static_cast<std::size_t>(height - 1 - y / scale)][static_cast<std::size_t>(x / scale)];
      map[Cell{x, y}] = c == '#' ? CellState::kOccupied : c == '?' ? CellState::kUnknown : CellState::kFree;
    }
  return map;
}

void expect_sound(const OccupancyGrid& grid, const TopologicalMap& map, double radius) {
  std::set<std::pair<int, int>> pairs;
  for (const Path& p : map.paths) {
    EXPECT_NE(p.from, p.to);
    EXPECT_TRUE(pairs.insert({p.from, p.to}).second) << "one path from one waypoint to another";
    Point at = map.waypoints[static_cast<std::size_t>(p.from)].pose.position();
    std::vector<Point> way = p.via;
    way.push_back(map.waypoints[static_cast<std::size_t>(p.to)].pose.position());
    double length = 0.0;
    for (const Point next : way) {
      EXPECT_TRUE(sweep_clear(grid, at, next, radius));
      length += distance(at, next);
      at = next;
    }
    EXPECT_NEAR(length, p.cost, 1e-9);
  }
  for (const auto& [from, to] : pairs) EXPECT_TRUE(pairs.contains({to, from}));
  for (std::size_t w = 0; w < map.waypoints.size(); ++w)  // one connected whole
    EXPECT_LT(costs_to(map, 0)[w], 1e9) << map.waypoints[w].id;
}

TEST(GridTopology, ACrossingHasFourWaysAndFourDeadEnds) {
  const OccupancyGrid grid = scaled({"#####.#####", "#####.#####", "#####.#####", "...........", "#####.#####", "#####.#####",
                                     "#####.#####"}, 8);
  const TopologicalMap map = topology_of(grid, {.radius = 0.2});
  EXPECT_EQ(count(map, SemanticState::kIntersection), 1);
  EXPECT_EQ(count(map, SemanticState::kDeadEnd), 4);
  EXPECT_EQ(map.waypoints.size(), 5U);
  EXPECT_EQ(map.paths.size(), 8U);
  expect_sound(grid, map, 0.2);
  for (const Waypoint& w : map.waypoints)
    if (w.state == SemanticState::kIntersection) {
      EXPECT_LT(distance(w.pose.position(), grid.geometry().center({44, 28})), 0.3);
    }
}

TEST(GridTopology, ADoorBetweenTwoRoomsIsAFunnel) {
  const OccupancyGrid grid = scaled({"###########", "#....#....#", "#....#....#", "#.........#", "#....#....#", "#....#....#",
                                     "###########"}, 6);
  const TopologicalMap map = topology_of(grid, {.radius = 0.2});
  EXPECT_EQ(count(map, SemanticState::kFunnel), 1);
  expect_sound(grid, map, 0.2);
}

TEST(GridTopology, ARingAndTwoWaysBetweenTwoPlacesGetWaypointsOfTheirOwn) {
  const OccupancyGrid ring = scaled({"......", ".####.", ".####.", "......"}, 8);
  const TopologicalMap map = topology_of(ring, {.radius = 0.2});
  EXPECT_GE(map.waypoints.size(), 3U);
  expect_sound(ring, map, 0.2);
  const OccupancyGrid theta = scaled({".........", ".#######.", ".........", ".#######.", "........."}, 8);
  expect_sound(theta, topology_of(theta, {.radius = 0.2}), 0.2);
}

TEST(GridTopology, UnknownCellsAreWallsAndTheLargestPartCounts) {
  const OccupancyGrid grid = scaled({"....?....", "....?....", "....?....", "....?...."}, 6);
  const TopologicalMap map = topology_of(grid, {.radius = 0.2});
  ASSERT_EQ(map.waypoints.size(), 1U);  // a single room is one place without ways
  EXPECT_LT(map.waypoints[0].pose.x, 1.5);
  EXPECT_EQ(map.waypoints[0].state, SemanticState::kFreeSpace);
}

TEST(GridTopology, NoRoomIsAnErrorThatSaysSo) {
  const OccupancyGrid grid = scaled({"###", "#.#", "###"}, 3);
  EXPECT_THROW(topology_of(grid, {.radius = 0.5}), InputError);
}

TEST(GridTopology, PathsAreFreeOfCollisionsOnRandomMaps) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    OccupancyGrid grid({0.1, {0.0, 0.0}, 120, 90}, CellState::kFree);
    for (int k = 0; k < 25; ++k) {
      const Cell corner{static_cast<int>(random() % 120), static_cast<int>(random() % 90)};
      const int width = 1 + static_cast<int>(random() % 15), height = 1 + static_cast<int>(random() % 15);
      for (int y = corner.y; y < std::min(90, corner.y + height); ++y)
        for (int x = corner.x; x < std::min(120, corner.x + width); ++x) grid[Cell{x, y}] = CellState::kOccupied;
    }
    for (const double radius : {0.15, 0.3}) expect_sound(grid, topology_of(grid, {.radius = radius}), radius);
  }
}

TEST(GridTopology, ExitsAreCountedFromTheLeft) {
  // Looking east: north is left of east is left of south.
  EXPECT_EQ(left_to_right({0.0, kPi / 2, -kPi / 2}, 0.0), (std::vector<int>{1, 0, 2}));
  // Looking west: south comes first.
  EXPECT_EQ(left_to_right({kPi, kPi / 2, -kPi / 2}, kPi), (std::vector<int>{1, 2, 0}));
}

TEST(SweptDisc, EqualsFineSampling) {
  std::mt19937_64 random(3);
  OccupancyGrid grid({1.0, {0.0, 0.0}, 20, 20}, CellState::kFree);
  for (int k = 0; k < 30; ++k) grid[random() % grid.size()] = CellState::kOccupied;
  const auto unit = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  for (int k = 0; k < 400; ++k) {
    const Point a{20 * unit(), 20 * unit()}, b{a.x + 6 * unit() - 3, a.y + 6 * unit() - 3};
    double nearest = 1e9;  // over samples of the way and all squares
    for (int s = 0; s <= 200; ++s) {
      const Point p{a.x + s / 200.0 * (b.x - a.x), a.y + s / 200.0 * (b.y - a.y)};
      nearest = std::min({nearest, p.x, p.y, 20 - p.x, 20 - p.y});
      for (std::size_t i = 0; i < grid.size(); ++i) {
        if (grid[i] == CellState::kFree) continue;
        const Cell c = grid.geometry().cell_at(i);
        nearest = std::min(nearest, std::hypot(std::max({c.x - p.x, 0.0, p.x - c.x - 1}), std::max({c.y - p.y, 0.0, p.y - c.y - 1})));
      }
    }
    EXPECT_FALSE(sweep_clear(grid, a, b, nearest > 0.0 ? nearest * 1.0001 : 1e-6));
    if (nearest > 0.03) {
      EXPECT_TRUE(sweep_clear(grid, a, b, nearest - 0.03));  // a step of the samples is 0.02
    }
  }
}

}  // namespace
}  // namespace outrider::decision
