#include "decision/frontier_map.hpp"

#include <gtest/gtest.h>

#include <random>

#include "decision/frontiers.hpp"
#include "support/random_map.hpp"

namespace outrider::decision {
namespace {

/// A map that starts unknown and becomes, in random pieces, one random map after the other.
TEST(FrontierMap, EqualsTheDefinitionAfterAnyChanges) {
  for (std::uint64_t seed = 0; seed < 150; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    OccupancyGrid map(test::random_map(seed, 24).geometry());
    FrontierMap frontiers(map.geometry());
    std::vector<char> was(map.size(), 0);
    for (int step = 0; step < 12; ++step) {
      std::vector<std::uint32_t> changed;
      for (std::size_t k = random() % (map.size() + 1); k-- > 0;) {
        const auto i = static_cast<std::uint32_t>(random() % map.size());
        map[i] = static_cast<CellState>(random() % 3);
        changed.push_back(i);
        if (random() % 8 == 0) changed.push_back(i);
      }
      std::vector<char> flips(map.size(), 0);
      for (const std::uint32_t i : frontiers.update(map, changed)) flips[i] ^= 1;
      std::size_t count = 0;
      for (std::size_t i = 0; i < map.size(); ++i) {
        const bool expected = is_frontier(map, map.geometry().cell_at(i));
        ASSERT_EQ(frontiers.is_frontier(i), expected) << "cell " << i << ", step " << step;
        ASSERT_EQ(flips[i] != 0, expected != (was[i] != 0)) << "cell " << i << ", step " << step;
        was[i] = expected;
        count += expected;
      }
      ASSERT_EQ(frontiers.count(), count);
    }
  }
}

TEST(FrontierMap, CompanyIsTheSizeOfTheCluster) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    SCOPED_TRACE(seed);
    const OccupancyGrid map = test::random_map(seed, 24);
    FrontierMap frontiers(map.geometry());
    std::vector<std::uint32_t> all(map.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    frontiers.update(map, all);
    FrontierExtractor extractor;
    const Frontiers& clusters = extractor.extract(map);
    for (const auto& cluster : clusters.clusters)
      for (std::uint32_t k = cluster.begin; k < cluster.end; ++k)
        for (const std::size_t least : {1U, 2U, 5U})
          ASSERT_EQ(frontiers.has_company(map.geometry().cell_at(clusters.cells[k]), least), cluster.size() >= least);
  }
}

}  // namespace
}  // namespace outrider::decision
