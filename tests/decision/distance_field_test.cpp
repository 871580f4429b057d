#include "decision/distance_field.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <queue>
#include <random>

#include "decision/passability.hpp"
#include "support/ascii.hpp"
#include "support/random_map.hpp"

namespace outrider::decision {
namespace {

constexpr int kFar = std::numeric_limits<int>::max();
constexpr std::array<Cell, 8> kAround{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};

int step_weight(Cell d, Steps steps) { return steps == Steps::kOrthogonal ? 1 : d.x != 0 && d.y != 0 ? 7 : 5; }

/// Dijkstra with a priority queue over step_allowed; weights in fifths of an edge, or edges.
Grid<int> oracle(Grid<std::uint8_t> mask, const std::vector<Cell>& sources, Steps steps, int limit = kFar - 10) {
  Grid<int> d(mask.geometry(), kFar);
  std::priority_queue<std::pair<int, std::size_t>, std::vector<std::pair<int, std::size_t>>, std::greater<>> queue;
  for (const Cell s : sources) {
    if (!mask.contains(s)) continue;
    mask[s] = 1;
    d[s] = 0;
    queue.emplace(0, mask.geometry().index(s));
  }
  while (!queue.empty()) {
    const auto [at, index] = queue.top();
    queue.pop();
    if (d[index] != at) continue;
    const Cell c = mask.geometry().cell_at(index);
    for (std::size_t k = 0; k < (steps == Steps::kOctile ? 8 : 4); ++k) {
      const Cell n{c.x + kAround[k].x, c.y + kAround[k].y};
      if (!step_allowed(mask, c, n)) continue;
      const int next = at + step_weight(kAround[k], steps);
      if (next >= d[n] || next > limit) continue;
      d[n] = next;
      queue.emplace(next, mask.geometry().index(n));
    }
  }
  return d;
}

void expect_equal(const DistanceField& field, const Grid<int>& expected, Steps steps) {
  const GridGeometry& g = expected.geometry();
  ASSERT_EQ(field.geometry(), g);
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const Cell c = g.cell_at(i);
    ASSERT_EQ(field.reached(c), expected[i] != kFar) << c.x << ' ' << c.y;
    const double metres = expected[i] * g.resolution / (steps == Steps::kOctile ? 5 : 1);
    if (!field.reached(c)) continue;
    ASSERT_DOUBLE_EQ(field.metres(c), metres) << c.x << ' ' << c.y;
  }
}

void expect_legal_path(const DistanceField& field, const Grid<std::uint8_t>& mask, Cell from, Steps steps) {
  const std::vector<Cell> path = field.path(from);
  ASSERT_FALSE(path.empty());
  ASSERT_EQ(path.front(), from);
  ASSERT_EQ(field.metres(path.back()), 0.0);
  int length = 0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    ASSERT_TRUE(step_allowed(mask, path[i - 1], path[i]));
    length += step_weight({path[i].x - path[i - 1].x, path[i].y - path[i - 1].y}, steps);
  }
  const double unit = field.geometry().resolution / (steps == Steps::kOctile ? 5 : 1);
  ASSERT_NEAR(length * unit, field.metres(from), 1e-9);
}

TEST(DistanceField, EqualsDijkstraOnRandomMaps) {
  DistanceField field;  // one for all: what the last map left must not matter
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    const auto map = test::random_map(seed, 40, 0.05);
    Grid<std::uint8_t> mask = passable_mask(map, seed % 4 == 0 ? 0.05 : 0.0);
    std::mt19937_64 random(seed);
    std::vector<Cell> sources;
    for (std::uint64_t i = 0; i < seed % 5; ++i) sources.push_back(map.geometry().cell_at(random() % map.size()));
    if (seed % 7 == 0) sources.push_back({-1, 3});  // ignored
    const Steps steps = seed % 2 == 0 ? Steps::kOctile : Steps::kOrthogonal;
    const int limit = seed % 3 == 0 ? static_cast<int>(seed % 100) : kFar - 10;
    const double max_m = seed % 3 == 0 ? limit * 0.05 / (steps == Steps::kOctile ? 5 : 1) : DistanceField::kNoLimit;
    field.compute(mask, sources, max_m, steps);
    expect_equal(field, oracle(mask, sources, steps, limit), steps);
    for (const Cell s : sources)
      if (mask.contains(s)) mask[s] = 1;
    for (std::size_t i = 0; i < map.size(); i += 7)
      if (const Cell c = map.geometry().cell_at(i); field.reached(c)) expect_legal_path(field, mask, c, steps);
    if (testing::Test::HasFailure()) return;
  }
}

TEST(DistanceField, TakesMoreBitsWhenPathsAreLong) {
  // A serpent of 241 lanes of 241 cells: 29,281 cells, 146,400 fifths of a cell, more than 16 bits hold.
  Grid<std::uint8_t> mask(GridGeometry{1.0, {}, 241, 241}, 1);
  for (int y = 1; y < 241; y += 2)
    for (int x = 0; x < 241; ++x) mask[Cell{x, y}] = x == (y % 4 == 1 ? 240 : 0);
  DistanceField field;
  for (const double limit : {DistanceField::kNoLimit, 20000.0, 13105.0, 13104.0, 13103.0, 100.0}) {
    SCOPED_TRACE(limit);
    const int fifths = std::isinf(limit) ? kFar - 10 : static_cast<int>(limit) * 5;
    field.compute(mask, std::vector<Cell>{{0, 0}}, limit);
    expect_equal(field, oracle(mask, {{0, 0}}, Steps::kOctile, fifths), Steps::kOctile);
  }
  field.compute(mask, std::vector<Cell>{{0, 0}});
  EXPECT_EQ(field.path({240, 240}).size(), 241U * 121U + 120U);
  field.compute(mask, std::vector<Cell>{{240, 240}}, DistanceField::kNoLimit, Steps::kOrthogonal);
  EXPECT_EQ(field.metres({0, 0}), 241.0 * 121.0 + 119.0);
}

TEST(DistanceField, DoesNotCutCorners) {
  const auto* text = R"(
    ..a
    .##
    b..)";
  DistanceField field;
  const auto mask = passable_mask(test::grid_from_ascii(text), 0.0);
  field.compute(mask, std::vector<Cell>{test::cell_marked(text, 'a')});
  EXPECT_DOUBLE_EQ(field.metres(test::cell_marked(text, 'b')), 4.0);
  EXPECT_FALSE(field.reached({1, 1}));
  EXPECT_EQ(field.metres({1, 1}), DistanceField::kNoLimit);
  EXPECT_FALSE(field.reached({-1, 0}));
  EXPECT_TRUE(field.path({1, 1}).empty());
  EXPECT_TRUE(field.path({7, 7}).empty());
}

TEST(DistanceField, PathsGoStraightWhereTheyCan) {
  DistanceField field;
  field.compute(Grid<std::uint8_t>(GridGeometry{1.0, {}, 9, 9}, 1), std::vector<Cell>{{8, 4}});
  const std::vector<Cell> path = field.path({0, 2});
  int turns = 0;
  for (std::size_t i = 2; i < path.size(); ++i) turns += path[i].y - path[i - 1].y != path[i - 1].y - path[i - 2].y;
  EXPECT_EQ(turns, 1);
  EXPECT_DOUBLE_EQ(field.metres({0, 2}), 6.0 + 2 * 1.4);
}

TEST(DistanceField, WithoutSourcesNothingIsReached) {
  DistanceField field;
  EXPECT_FALSE(field.reached({0, 0}));
  field.compute(Grid<std::uint8_t>(GridGeometry{1.0, {}, 3, 3}, 1), {});
  EXPECT_FALSE(field.reached({0, 0}));
  field.compute(Grid<std::uint8_t>(), std::vector<Cell>{{0, 0}});
  EXPECT_FALSE(field.reached({0, 0}));
}

TEST(DistanceField, BlockedSourcesAreSeeds) {
  Grid<std::uint8_t> mask(GridGeometry{.width = 9, .height = 1}, 1);
  for (const int x : {3, 4, 5}) mask[Cell{x, 0}] = 0;
  DistanceField field;
  field.compute(mask, std::vector<Cell>{{3, 0}});
  EXPECT_EQ(field.metres({0, 0}), 3.0);
  EXPECT_EQ(field.metres({3, 0}), 0.0);
  EXPECT_FALSE(field.reached({4, 0}));
}

}  // namespace
}  // namespace outrider::decision
