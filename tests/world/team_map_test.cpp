#include "world/team_map.hpp"

#include <gtest/gtest.h>

#include <random>

namespace outrider {
namespace {

const GridGeometry kSmall{1.0, {0.0, 0.0}, 6, 5};

std::uint8_t value(CellState state, int version) { return static_cast<std::uint8_t>(version * 4 + static_cast<int>(state)); }

// Robots that disagree, change their minds, and hear everything in another order and twice still agree in the end.
TEST(TeamMap, EndsEqualWhateverTheOrderOfTheNews) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    std::vector<TeamMap> maps(3, TeamMap(kSmall));
    std::vector<CellRun> news;
    for (int k = 0; k < 120; ++k) {
      TeamMap& map = maps[random() % maps.size()];
      map.observe(static_cast<std::uint32_t>(random() % kSmall.size()),
                  random() % 2 ? CellState::kFree : CellState::kOccupied);
      for (const auto& change : map.take_to_share()) news.push_back(change);
      if (random() % 3 == 0 && !news.empty()) maps[random() % maps.size()].merge(news[random() % news.size()]);
    }
    for (TeamMap& map : maps) {
      std::vector<CellRun> mail = news;
      mail.insert(mail.end(), news.begin(), news.begin() + static_cast<std::ptrdiff_t>(news.size() / 2));
      std::shuffle(mail.begin(), mail.end(), random);
      for (const auto& change : mail) map.merge(change);
    }
    EXPECT_EQ(maps[0].states(), maps[1].states());
    EXPECT_EQ(maps[1].states(), maps[2].states());
    EXPECT_EQ(maps[0].hash(), maps[1].hash());
    EXPECT_EQ(maps[0].mark(0), maps[2].mark(0));
  }
}

// Versions are kept only where there are any; a plain array of values knows them all.
TEST(TeamMap, HoldsTheGreatestValueOfEveryCell) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    TeamMap map({1.0, {0.0, 0.0}, 70, 40});
    std::vector<std::uint8_t> plain(map.states().size(), 0);
    const unsigned most = seed % 3 == 0 ? 12 : 3;  // mostly first versions, or many
    for (int k = 0; k < 200; ++k) {
      const CellRun run{static_cast<std::uint32_t>(random() % plain.size()), static_cast<std::uint8_t>(1 + random() % 60),
                        static_cast<std::uint8_t>(4 + random() % most)};
      map.merge(run);
      for (std::size_t i = run.index; i < std::min<std::size_t>(run.index + run.length, plain.size()); ++i)
        if ((run.value & 3) != 3) plain[i] = std::max(plain[i], run.value);  // 3 is no state
    }
    for (std::size_t i = 0; i < plain.size(); ++i) ASSERT_EQ(static_cast<int>(map.states()[i]), plain[i] & 3) << i;
    for (std::size_t tile = 0; tile < map.tiling().count(); ++tile) {
      std::vector<std::uint8_t> expected;
      map.tiling().for_cells(tile, [&](std::size_t i) { expected.push_back(plain[i]); });
      ASSERT_EQ(map.tile(tile), expected) << tile;
    }
  }
}

TEST(TeamMap, ReportsWhatChangedAndSharesOnlyItsOwnNews) {
  TeamMap map(kSmall);
  EXPECT_TRUE(map.observe(3, CellState::kFree));
  EXPECT_FALSE(map.observe(3, CellState::kFree));
  EXPECT_TRUE(map.merge({7, 1, value(CellState::kOccupied, 1)}));
  EXPECT_FALSE(map.merge({7, 1, value(CellState::kOccupied, 1)}));
  EXPECT_FALSE(map.merge({7, 1, value(CellState::kFree, 1)}));   // occupied stands at equal versions
  EXPECT_TRUE(map.merge({7, 1, value(CellState::kFree, 2)}));    // news replaces
  EXPECT_FALSE(map.merge({1000, 3, value(CellState::kFree, 9)}));  // outside
  const auto shared = map.take_to_share();
  ASSERT_EQ(shared.size(), 1U);
  EXPECT_EQ(shared[0].index, 3U);
  EXPECT_TRUE(map.take_to_share().empty());
  EXPECT_EQ(map.take_changed(), (std::vector<std::uint32_t>{3, 7, 7}));
}

TEST(TeamMap, SharesRunsOfEqualCells) {
  TeamMap map({1.0, {0.0, 0.0}, 400, 2});
  for (std::uint32_t i = 0; i < 300; ++i) map.observe(i, CellState::kFree);
  map.observe(300, CellState::kOccupied);
  const auto runs = map.take_to_share();
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[0].length, 255);
  EXPECT_EQ(runs[1].index, 255U);
  EXPECT_EQ(runs[1].length, 45);
  EXPECT_EQ(runs[2].value, value(CellState::kOccupied, 1));
}

// The laws that catching up rests on, over maps whose edges cut tiles.
TEST(TeamMap, OfTwoDifferentTilesTheHeavierKnowsSomethingMore) {
  const GridGeometry g{1.0, {0.0, 0.0}, 70, 40};
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    TeamMap a(g), b(g);
    for (int k = 0; k < 300; ++k) {
      const auto i = static_cast<std::uint32_t>(random() % g.size());
      const auto s = random() % 3 ? CellState::kFree : CellState::kOccupied;
      if (random() % 4) a.observe(i, s);
      if (random() % 2) b.observe(i, s);
    }
    for (std::size_t tile = 0; tile < a.tiling().count(); ++tile) {
      const bool same = a.tile(tile) == b.tile(tile);
      EXPECT_EQ(same, a.mark(tile) == b.mark(tile)) << tile;
      if (same || a.mark(tile).weight < b.mark(tile).weight) continue;
      const TileMark before = b.mark(tile);
      b.merge_tile(tile, a.tile(tile));  // b learns, and is at least as heavy as a now
      EXPECT_NE(before, b.mark(tile));
      EXPECT_GE(b.mark(tile).weight, a.mark(tile).weight);
    }
    for (std::size_t tile = 0; tile < a.tiling().count(); ++tile) {
      EXPECT_LE(a.tile(tile).size(), 1024U);
      a.merge_tile(tile, b.tile(tile));
      b.merge_tile(tile, a.tile(tile));
    }
    EXPECT_EQ(a.hash(), b.hash());
    EXPECT_EQ(a.states(), b.states());
  }
  TeamMap map(g);
  EXPECT_FALSE(map.merge_tile(99, std::vector<std::uint8_t>(1024, 5)));
  EXPECT_FALSE(map.merge_tile(0, std::vector<std::uint8_t>(1023, 5)));
  EXPECT_EQ(map.hash(), 0U);
}

}  // namespace
}  // namespace outrider
