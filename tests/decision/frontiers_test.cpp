#include "decision/frontiers.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <limits>
#include <random>
#include <set>

#include "support/ascii.hpp"
#include "support/random_map.hpp"

namespace outrider::decision {
namespace {

using test::grid_from_ascii;

/// Flood fill over is_frontier, by the definition.
std::vector<std::vector<std::uint32_t>> oracle_clusters(const OccupancyGrid& map) {
  std::vector<std::vector<std::uint32_t>> clusters;
  std::set<std::uint32_t> seen;
  const GridGeometry& g = map.geometry();
  for (std::uint32_t i = 0; i < map.size(); ++i) {
    if (!is_frontier(map, g.cell_at(i)) || !seen.insert(i).second) continue;
    std::vector<std::uint32_t> cluster;
    std::deque<std::uint32_t> queue{i};
    while (!queue.empty()) {
      const Cell c = g.cell_at(queue.front());
      cluster.push_back(queue.front());
      queue.pop_front();
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const Cell n{c.x + dx, c.y + dy};
          if (!is_frontier(map, n)) continue;
          if (const auto at = static_cast<std::uint32_t>(g.index(n)); seen.insert(at).second) queue.push_back(at);
        }
    }
    std::sort(cluster.begin(), cluster.end());
    clusters.push_back(cluster);
  }
  return clusters;
}

/// By brute force, in whole numbers: n times the offset from the centroid.
Cell oracle_medoid(const GridGeometry& g, const std::vector<std::uint32_t>& cluster) {
  const auto n = static_cast<std::int64_t>(cluster.size());
  std::int64_t sum_x = 0, sum_y = 0, best = std::numeric_limits<std::int64_t>::max();
  for (const std::uint32_t i : cluster) sum_x += g.cell_at(i).x, sum_y += g.cell_at(i).y;
  Cell medoid;
  for (const std::uint32_t i : cluster) {
    const std::int64_t dx = n * g.cell_at(i).x - sum_x, dy = n * g.cell_at(i).y - sum_y;
    if (dx * dx + dy * dy >= best) continue;
    best = dx * dx + dy * dy;
    medoid = g.cell_at(i);
  }
  return medoid;
}

void expect_equals_oracle(const OccupancyGrid& map, const Frontiers& found) {
  const auto expected = oracle_clusters(map);
  ASSERT_EQ(found.clusters.size(), expected.size());
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const FrontierCluster& cluster = found.clusters[i];
    ASSERT_EQ(cluster.begin, begin);
    ASSERT_EQ(cluster.size(), expected[i].size());
    begin = cluster.end;
    const std::vector<std::uint32_t> cells(found.cells.begin() + cluster.begin, found.cells.begin() + cluster.end);
    EXPECT_EQ(cells, expected[i]);
    EXPECT_EQ(cluster.medoid, oracle_medoid(map.geometry(), expected[i]));
    Point mean;
    for (const std::uint32_t c : expected[i]) {
      const Point center = map.geometry().center(map.geometry().cell_at(c));
      mean = {mean.x + center.x / static_cast<double>(cells.size()),
              mean.y + center.y / static_cast<double>(cells.size())};
    }
    EXPECT_NEAR(cluster.centroid.x, mean.x, 1e-9);
    EXPECT_NEAR(cluster.centroid.y, mean.y, 1e-9);
  }
  EXPECT_EQ(found.cells.size(), begin);
}

TEST(Frontiers, EqualFloodFillOnRandomMaps) {
  FrontierExtractor extractor;  // one for all: its workspace must not leak from map to map
  for (std::uint64_t seed = 0; seed < 600; ++seed) {
    SCOPED_TRACE(seed);
    const OccupancyGrid map = test::random_map(seed, seed % 50 == 0 ? 150 : 40, 0.05);
    expect_equals_oracle(map, extractor.extract(map));
    if (testing::Test::HasFailure()) return;
  }
}

TEST(Frontiers, AreTheFreeCellsBesideTheUnknown) {
  const auto* text = R"(
    ????????
    ??abc###
    ##d..ef?
    ##...#g#
    ##....h?
    )";
  const OccupancyGrid map = grid_from_ascii(text);
  FrontierExtractor extractor;
  const Frontiers& found = extractor.extract(map);
  std::set<std::uint32_t> expected;
  for (const char mark : std::string("abcdefgh"))
    expected.insert(static_cast<std::uint32_t>(map.geometry().index(test::cell_marked(text, mark))));
  // 'e' lies beside 'c' and below '#', two cells from the unknown: free, but no frontier.
  expected.erase(static_cast<std::uint32_t>(map.geometry().index(test::cell_marked(text, 'e'))));
  EXPECT_EQ(std::set<std::uint32_t>(found.cells.begin(), found.cells.end()), expected);
  EXPECT_EQ(found.clusters.size(), 2U);
}

TEST(Frontiers, OutsideTheMapCountsAsKnown) {
  FrontierExtractor extractor;
  EXPECT_TRUE(extractor.extract(grid_from_ascii("...\n...\n...")).clusters.empty());
  EXPECT_TRUE(extractor.extract(grid_from_ascii(".")).clusters.empty());
  EXPECT_TRUE(extractor.extract(grid_from_ascii("?")).clusters.empty());
  EXPECT_TRUE(extractor.extract(OccupancyGrid{}).clusters.empty());
  EXPECT_EQ(extractor.extract(grid_from_ascii(".?")).clusters.size(), 1U);
}

TEST(Frontiers, DiagonalNeighboursAreOneCluster) {
  FrontierExtractor extractor;
  EXPECT_EQ(extractor.extract(grid_from_ascii(".??\n?.?\n??.")).clusters.size(), 1U);
  EXPECT_EQ(extractor.extract(grid_from_ascii(".??\n???\n??.")).clusters.size(), 2U);
}

TEST(Frontiers, ArmsThatMeetLateAreOneCluster) {
  // A comb: the union-find joins the teeth, seen first, only at the top row.
  FrontierExtractor extractor;
  const Frontiers& found = extractor.extract(grid_from_ascii(R"(
    ...........
    .?.?.?.?.?.
    .?.?.?.?.?.)"));
  ASSERT_EQ(found.clusters.size(), 1U);
  EXPECT_EQ(found.clusters[0].size(), 11U + 12U);
  EXPECT_EQ(found.clusters[0].medoid, (Cell{5, 2}));
}

TEST(Frontiers, CentroidOfOneCellIsThatCell) {
  // m-explore leaves the first cell out of its sums, and a frontier of one cell ends up at the origin.
  FrontierExtractor extractor;
  OccupancyGrid map(GridGeometry{0.05, {1.0, 2.0}, 30, 20});
  map[Cell{10, 4}] = CellState::kFree;
  const Frontiers& found = extractor.extract(map);
  ASSERT_EQ(found.clusters.size(), 1U);
  EXPECT_NEAR(found.clusters[0].centroid.x, 1.525, 1e-12);
  EXPECT_NEAR(found.clusters[0].centroid.y, 2.225, 1e-12);
  EXPECT_EQ(found.clusters[0].medoid, (Cell{10, 4}));
}

TEST(Frontiers, OfARectangleAreThoseOfTheDefinition) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const OccupancyGrid map = test::random_map(seed, seed % 4 == 0 ? 200 : 30);
    const auto below = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
    const Cell low{below(map.width()), below(map.height())};
    const Cell high{low.x + 1 + below(map.width() - low.x), low.y + 1 + below(map.height() - low.y)};
    std::vector<Cell> found, expected;
    for_frontier(map, low, high, [&](Cell c) { found.push_back(c); });
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x)
        if (is_frontier(map, {x, y})) expected.push_back({x, y});
    ASSERT_EQ(found, expected);
  }
}

}  // namespace
}  // namespace outrider::decision
