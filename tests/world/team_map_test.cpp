#include "world/team_map.hpp"

#include <gtest/gtest.h>

#include <random>

namespace outrider {
namespace {

const GridGeometry kSmall{1.0, {0.0, 0.0}, 6, 5};

// Robots that disagree, change their minds, and hear everything in another order and twice still agree in the end.
TEST(TeamMap, EndsEqualWhateverTheOrderOfTheNews) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    std::vector<TeamMap> maps(3, TeamMap(kSmall));
    std::vector<CellChange> news;
    for (int k = 0; k < 120; ++k) {
      TeamMap& map = maps[random() % maps.size()];
      map.observe(static_cast<std::uint32_t>(random() % kSmall.size()),
                  random() % 2 ? CellState::kFree : CellState::kOccupied);
      for (const auto& change : map.take_to_share()) news.push_back(change);
      if (random() % 3 == 0 && !news.empty()) maps[random() % maps.size()].merge(news[random() % news.size()]);
    }
    for (TeamMap& map : maps) {
      std::vector<CellChange> mail = news;
      mail.insert(mail.end(), news.begin(), news.begin() + static_cast<std::ptrdiff_t>(news.size() / 2));
      std::shuffle(mail.begin(), mail.end(), random);
      for (const auto& change : mail) map.merge(change);
    }
    EXPECT_EQ(maps[0].states(), maps[1].states());
    EXPECT_EQ(maps[1].states(), maps[2].states());
  }
}

TEST(TeamMap, ReportsWhatChangedAndSharesOnlyItsOwnNews) {
  TeamMap map(kSmall);
  EXPECT_TRUE(map.observe(3, CellState::kFree));
  EXPECT_FALSE(map.observe(3, CellState::kFree));
  EXPECT_TRUE(map.merge({7, CellState::kOccupied, 1}));
  EXPECT_FALSE(map.merge({7, CellState::kOccupied, 1}));
  EXPECT_FALSE(map.merge({7, CellState::kFree, 1}));   // occupied stands at equal versions
  EXPECT_TRUE(map.merge({7, CellState::kFree, 2}));    // news replaces
  EXPECT_FALSE(map.merge({1000, CellState::kFree, 9}));  // outside
  const auto shared = map.take_to_share();
  ASSERT_EQ(shared.size(), 1U);
  EXPECT_EQ(shared[0].index, 3U);
  EXPECT_TRUE(map.take_to_share().empty());
  EXPECT_EQ(map.take_changed(), (std::vector<std::uint32_t>{3, 7, 7}));
}

}  // namespace
}  // namespace outrider
