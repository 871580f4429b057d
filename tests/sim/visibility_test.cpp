#include "sim/visibility.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "random_world.hpp"
#include "sim/world.hpp"
#include "support/ascii.hpp"
#include "world/ray.hpp"

namespace outrider::sim {
namespace {

using test::draw;
using test::grid_from_ascii;

/// What a fresh robot sees from `from`, drawn: '?' for what it does not see.
std::string seen_from(const OccupancyGrid& map, Cell from, double range) {
  std::vector<std::uint8_t> seen(map.size(), 0);
  std::vector<SeenCell> cells;
  CellSensor(map, range).sense(from, seen, cells);
  OccupancyGrid picture(map.geometry(), CellState::kUnknown);
  for (const SeenCell& cell : cells) {
    EXPECT_EQ(picture[cell.index], CellState::kUnknown) << "reported twice";
    EXPECT_EQ(seen[cell.index], 1);
    picture[cell.index] = cell.state;
  }
  return test::to_ascii(picture);
}

/// The rule of the header, cell by cell, each asking its parent anew.
class SlowSensor {
 public:
  SlowSensor(const OccupancyGrid& map, Cell from, double range) : map_(map), from_(from) {
    const VisibilityTree tree(range / map.geometry().resolution, 1000);
    for (const auto& node : tree.nodes())
      parents_[key(node.offset)] = tree.nodes()[static_cast<std::size_t>(node.parent)].offset;
  }

  bool free_and_seen(Cell offset) const {
    const auto parent = parents_.find(key(offset));
    if (parent == parents_.end() || solid(offset)) return false;
    if (offset == Cell{}) return true;
    const Cell p = parent->second;
    if (p.x != offset.x && p.y != offset.y && solid({p.x, offset.y}) && solid({offset.x, p.y})) return false;
    return free_and_seen(p);
  }

  bool seen(Cell offset) const {
    const Cell at{from_.x + offset.x, from_.y + offset.y};
    if (!map_.contains(at) || parents_.count(key(offset)) == 0) return false;
    if (!solid(offset)) return free_and_seen(offset);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const Cell beside{offset.x + dx, offset.y + dy};
        if (std::abs(beside.x) <= std::abs(offset.x) && std::abs(beside.y) <= std::abs(offset.y) &&
            free_and_seen(beside))
          return true;
      }
    return false;
  }

 private:
  static std::pair<int, int> key(Cell c) { return {c.x, c.y}; }
  bool solid(Cell offset) const {
    const Cell at{from_.x + offset.x, from_.y + offset.y};
    return !map_.contains(at) || map_[at] != CellState::kFree;
  }

  const OccupancyGrid& map_;
  Cell from_;
  std::map<std::pair<int, int>, Cell> parents_;
};

TEST(VisibilityTree, HoldsTheWholeDiscInDepthFirstOrder) {
  for (const double range : {0.0, 0.99, 1.0, 1.5, 4.0, 8.0, 23.7}) {
    SCOPED_TRACE(range);
    const VisibilityTree tree(range, 1000);
    std::set<std::pair<int, int>> offsets;
    for (std::size_t i = 0; i < tree.nodes().size(); ++i) {
      const auto& node = tree.nodes()[i];
      offsets.insert({node.offset.x, node.offset.y});
      EXPECT_LE(std::hypot(node.offset.x, node.offset.y), range + 1e-9);
      if (i == 0) continue;
      const auto& parent = tree.nodes()[static_cast<std::size_t>(node.parent)];
      EXPECT_LT(node.parent, static_cast<int>(i));
      EXPECT_LE(node.end, parent.end);
      EXPECT_GT(node.end, static_cast<int>(i));
      const int longer = std::max(std::abs(node.offset.x), std::abs(node.offset.y));
      EXPECT_EQ(std::max(std::abs(parent.offset.x), std::abs(parent.offset.y)), longer - 1);
      EXPECT_LE(std::abs(parent.offset.x - node.offset.x), 1);
      EXPECT_LE(std::abs(parent.offset.y - node.offset.y), 1);
    }
    EXPECT_EQ(offsets.size(), tree.nodes().size());
    std::size_t expected = 0;
    for (int y = -30; y <= 30; ++y)
      for (int x = -30; x <= 30; ++x) expected += std::hypot(x, y) <= range + 1e-9;
    EXPECT_EQ(tree.nodes().size(), expected);
  }
}

TEST(VisibilityTree, WaysKeepNearTheStraightLine) {
  const VisibilityTree tree(50.0, 1000);
  double worst = 0.0;
  for (const auto& node : tree.nodes())
    for (int at = node.parent; at > 0; at = tree.nodes()[static_cast<std::size_t>(at)].parent) {
      const Cell on = tree.nodes()[static_cast<std::size_t>(at)].offset;
      const double across = on.x * node.offset.y - on.y * node.offset.x;
      worst = std::max(worst, std::abs(across) / std::hypot(node.offset.x, node.offset.y));
    }
  EXPECT_LT(worst, 1.7) << "cells off the line";
}

TEST(VisibilityTree, IsCutToTheMap) {
  const VisibilityTree tree(1e6, 5);
  for (const auto& node : tree.nodes()) EXPECT_LE(std::max(std::abs(node.offset.x), std::abs(node.offset.y)), 5);
}

TEST(CellSensor, SeesTheDrawnCells) {
  const OccupancyGrid room = grid_from_ascii(R"(
    #########
    #.......#
    #.......#
    #.......#
    #########)");
  EXPECT_EQ(seen_from(room, {4, 2}, 20.0), test::to_ascii(room));  // walls and inner corners too
  EXPECT_EQ(seen_from(room, {4, 2}, 2.0), test::tidy_ascii(R"(
    ????#????
    ???...???
    ??.....??
    ???...???
    ????#????)"));
  EXPECT_EQ(seen_from(room, {1, 1}, 0.0), test::tidy_ascii(R"(
    ?????????
    ?????????
    ?????????
    ?.???????
    ?????????)"));
}

TEST(CellSensor, AWallCastsAShadow) {
  EXPECT_EQ(seen_from(grid_from_ascii(R"(
    .......
    .......
    ...#...
    .......
    .......)"),
                      {3, 1}, 10.0),
            test::tidy_ascii(R"(
    .?????.
    ..???..
    ...#...
    .......
    .......)"));
}

TEST(CellSensor, NothingIsSeenBehindAClosedWallDiagonalOrNot) {
  const OccupancyGrid map = grid_from_ascii(R"(
    ......#...
    .....#....
    ....#.....
    ...#......
    ..#.......
    .#........
    #.........)");
  std::vector<std::uint8_t> seen(map.size(), 0);
  std::vector<SeenCell> cells;
  const CellSensor sensor(map, 20.0);
  for (std::size_t i = 0; i < map.size(); ++i)
    if (const Cell c = map.geometry().cell_at(i); c.y > c.x) sensor.sense(c, seen, cells);
  for (const SeenCell& cell : cells) {
    const Cell c = map.geometry().cell_at(cell.index);
    EXPECT_GE(c.y, c.x) << c.x << ' ' << c.y;
  }
}

TEST(CellSensor, AgreesWithTheSlowRule) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const double resolution = seed % 2 == 0 ? 1.0 : 0.25, range = uniform(random, 0.0, 12.0) * resolution;
    OccupancyGrid map = random_map(25, 18, resolution, uniform(random, 0.0, 0.35), random);
    const Cell from{static_cast<int>(random() % 25), static_cast<int>(random() % 18)};
    map[from] = CellState::kFree;
    const SlowSensor slow(map, from, range);
    const std::string expected = draw(map.geometry(), [&](Cell c) {
      if (!slow.seen({c.x - from.x, c.y - from.y})) return '?';
      return map[c] == CellState::kFree ? '.' : '#';
    });
    EXPECT_EQ(seen_from(map, from, range), expected) << test::to_ascii(map, {{'R', from}});
  }
}

/// The exact line between centres counts every cell it touches, the rule only one a step: it sees a little more.
TEST(CellSensor, MostlyAgreesWithExactLinesOfSight) {
  for (const char* name : {"field", "office1", "labyrinth"}) {
    SCOPED_TRACE(name);
    const World world = embedded_world(name);
    const GridGeometry& g = world.map.geometry();
    const double range = world.team[1].range;
    const CellSensor sensor(world.map, range);
    std::size_t cells = 0, agree = 0;
    for (const Pose2& start : world.starts) {
      const Cell from = g.cell_of(start.position());
      std::vector<std::uint8_t> seen(world.map.size(), 0);
      std::vector<SeenCell> list;
      sensor.sense(from, seen, list);
      for (std::size_t i = 0; i < world.map.size(); ++i) {
        const Cell c = g.cell_at(i);
        if (world.map[i] != CellState::kFree || distance(g.center(c), g.center(from)) > range) continue;
        ++cells;
        agree += (seen[i] != 0) == line_of_sight(world.map, from, c);
      }
    }
    EXPECT_GT(static_cast<double>(agree) / static_cast<double>(cells), 0.95);
  }
}

TEST(CellSensor, ReportsEveryCellOnce) {
  std::mt19937_64 random(5);
  const OccupancyGrid map = random_map(30, 30, 1.0, 0.1, random);
  std::vector<std::uint8_t> seen(map.size(), 0);
  std::vector<SeenCell> cells;
  const CellSensor sensor(map, 6.0);
  for (std::size_t i = 0; i < map.size(); ++i)
    if (map[i] == CellState::kFree) sensor.sense(map.geometry().cell_at(i), seen, cells);
  std::set<std::uint32_t> indices;
  for (const SeenCell& cell : cells) {
    EXPECT_TRUE(indices.insert(cell.index).second);
    EXPECT_EQ(cell.state, map[cell.index]);
  }
}

}  // namespace
}  // namespace outrider::sim
