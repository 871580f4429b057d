#include "decision/reach_field.hpp"

#include <gtest/gtest.h>

#include <random>

#include "decision/distance_field.hpp"
#include "support/random_map.hpp"

namespace outrider::decision {
namespace {

/// Many searches on one mask that changes in between: none may see another's traces, however far each went.
TEST(ReachField, EqualsTheFullFieldAsFarAsItWentWhateverCameBefore) {
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const GridGeometry g = test::random_map(seed, 30, 0.5).geometry();
    Grid<std::uint8_t> mask(g);
    ReachField reach(g);
    DistanceField full;
    for (int search = 0; search < 12; ++search) {
      std::vector<std::uint32_t> changed;
      for (std::size_t k = random() % (g.size() + 1); k-- > 0;) {
        const auto i = static_cast<std::uint32_t>(random() % g.size());
        mask[i] = random() % 4 != 0;
        changed.push_back(i);
      }
      if (search % 3 != 0 || search == 0) reach.update(mask, changed);
      else for (const std::uint32_t i : changed) reach.update(mask, {&i, 1});
      const Cell source = g.cell_at(random() % g.size());
      const Cell sources[] = {source};
      full.compute(mask, sources);
      reach.begin(source);
      for (double limit = 0.0; limit < 12.0; limit += 0.1 * static_cast<double>(random() % 40)) {
        reach.extend(limit);
        for (std::size_t i = 0; i < g.size(); ++i) {
          const Cell c = g.cell_at(i);
          if (full.metres(c) <= limit || reach.reached(c)) {
            ASSERT_EQ(reach.metres(c), full.metres(c)) << "cell " << i << " to " << limit;
          }
        }
      }
      reach.extend(ReachField::kNoLimit);
      EXPECT_TRUE(reach.exhausted());
      for (std::size_t i = 0; i < g.size(); ++i) {
        ASSERT_EQ(reach.metres(g.cell_at(i)), full.metres(g.cell_at(i))) << "cell " << i;
        ASSERT_EQ(reach.path(g.cell_at(i)), full.path(g.cell_at(i)));
      }
    }
  }
}

/// One way that winds through the whole map, far longer than the map is wide.
TEST(ReachField, LongWaysAreNotConfusedWithEarlierSearches) {
  const GridGeometry g{.width = 41, .height = 41};
  Grid<std::uint8_t> mask(g, 1);
  for (int y = 1; y < g.height; y += 2)
    for (int x = 0; x < g.width; ++x) mask[Cell{x, y}] = x == (y % 4 == 1 ? g.width - 1 : 0);
  std::vector<std::uint32_t> all(g.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  ReachField reach(g);
  reach.update(mask, all);
  DistanceField full;
  for (int search = 0; search < 6; ++search) {
    const Cell source{0, search % 2 == 0 ? 0 : g.height - 1};
    const Cell sources[] = {source};
    full.compute(mask, sources);
    reach.begin(source);
    reach.extend(search < 4 ? ReachField::kNoLimit : 30.0);
    for (std::size_t i = 0; i < g.size(); ++i) {
      if (search >= 4 && !reach.reached(g.cell_at(i))) continue;
      ASSERT_EQ(reach.metres(g.cell_at(i)), full.metres(g.cell_at(i))) << "search " << search << ", cell " << i;
    }
  }
}

TEST(ReachField, FindsNothingBeforeItBegins) {
  const GridGeometry g{.width = 5, .height = 5};
  ReachField reach(g);
  for (std::size_t i = 0; i < g.size(); ++i) EXPECT_FALSE(reach.reached(g.cell_at(i)));
  EXPECT_FALSE(reach.reached({-1, 2}));
}

}  // namespace
}  // namespace outrider::decision
