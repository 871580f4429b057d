#include "link/radio.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/ascii.hpp"

namespace outrider::link {
namespace {

const OccupancyGrid kOpen({1.0, {0.0, 0.0}, 40, 10}, CellState::kFree);

Radio radio(const RadioSpec& spec, const OccupancyGrid& truth = kOpen, std::vector<Point> at = {{0.5, 0.5}, {9.5, 0.5}, {9.5, 9.5}}) {
  return Radio(spec, 100.0, truth, [at = std::move(at)](RobotId r) { return at[static_cast<std::size_t>(r)]; });
}

TEST(Radio, RandomBreaksDoNotOverlapAndStayWithinTheHorizon) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    RadioSpec spec{.random_breaks = {{5, 25.0, 0.0}, {3, 4.0, 0.0}}, .seed = seed};
    const auto breaks = schedule(spec, 400.0);
    ASSERT_EQ(breaks.size(), 8U);
    double sum = 0.0, end = 0.0;
    for (const Break& b : breaks) {
      EXPECT_GE(b.begin_s, end);
      end = b.end_s;
      sum += b.end_s - b.begin_s;
    }
    EXPECT_LE(end, 400.0 + 1e-9);
    EXPECT_NEAR(sum, 137.0, 1e-9);
    EXPECT_EQ(schedule(spec, 400.0)[3].begin_s, breaks[3].begin_s);
  }
}

TEST(Radio, RandomBreaksFallEverywhereInTheHorizonAlike) {
  constexpr int kRuns = 4000;
  std::vector<int> in_break(10, 0);  // at the middle of each tenth
  for (int seed = 0; seed < kRuns; ++seed)
    for (const Break& b : schedule({.random_breaks = {{1, 50.0, 100.0}}, .seed = static_cast<std::uint64_t>(seed)}, 1e6))
      for (int k = 0; k < 10; ++k) in_break[static_cast<std::size_t>(k)] += b.cuts(0, 1, 10.0 * k + 5.0);
  for (int k = 0; k < 10; ++k) {  // one break of 50 s in 100 s covers t with probability min(t, 100 - t) / 50
    const double t = 10.0 * k + 5.0, expected = std::min({t, 100.0 - t, 50.0}) / 50.0;
    EXPECT_NEAR(in_break[static_cast<std::size_t>(k)] / double{kRuns}, expected, 0.04) << t;
  }
}

TEST(Radio, AHorizonTooShortForTheBreaksIsStretched) {
  const auto breaks = schedule({.random_breaks = {{5, 40.0, 0.0}}}, 10.0);
  EXPECT_LE(breaks.back().end_s, 400.0);
}

TEST(Radio, ABreakSilencesTheNamedAndASplitDividesTheTeam) {
  auto r = radio({.breaks = {{Break::Kind::kSilence, 10.0, 20.0, {1}}, {Break::Kind::kSplit, 30.0, 40.0, {2, 0}}}});
  EXPECT_TRUE(r(0, 1, 9.9));
  EXPECT_FALSE(r(0, 1, 10.0));
  EXPECT_FALSE(r(1, 2, 19.9));
  EXPECT_TRUE(r(0, 2, 15.0));
  EXPECT_TRUE(r(0, 1, 20.0));
  EXPECT_TRUE(r(0, 2, 35.0));
  EXPECT_FALSE(r(1, 0, 35.0));
}

TEST(Radio, WhatIsSaidShortlyBeforeABreakIsLostOnTheWay) {
  auto r = radio({.delay_s = 2.0, .breaks = {{Break::Kind::kSilence, 10.0, 20.0, {}}}});
  EXPECT_EQ(r(0, 1, 7.9), 2.0);
  EXPECT_FALSE(r(0, 1, 8.5));
  EXPECT_FALSE(r(0, 1, 19.0));
  EXPECT_TRUE(r(0, 1, 20.0));
}

TEST(Radio, RangeAndSightLimitTheReach) {
  EXPECT_TRUE(radio({.range_m = 9.0})(0, 1, 0.0));
  EXPECT_FALSE(radio({.range_m = 9.0})(0, 2, 0.0));
  const auto walled = test::grid_from_ascii(R"(
    ..#..
    .....
  )");
  const std::vector<Point> at{{0.5, 1.5}, {4.5, 1.5}, {4.5, 0.5}};
  EXPECT_FALSE(radio({.line_of_sight = true}, walled, at)(0, 1, 0.0));
  EXPECT_TRUE(radio({.line_of_sight = true}, walled, at)(1, 2, 0.0));
}

TEST(Radio, LossesAreAsFrequentAsAskedForAndRepeatable) {
  auto a = radio({.loss = 0.3, .seed = 5}), b = radio({.loss = 0.3, .seed = 5});
  int lost = 0;
  for (int k = 0; k < 10000; ++k) {
    const bool heard = a(0, 1, 0.0).has_value();
    lost += !heard;
    EXPECT_EQ(heard, b(0, 1, 0.0).has_value());
  }
  EXPECT_NEAR(lost / 10000.0, 0.3, 0.02);
}

TEST(Radio, TheDeafSpeakAndHearNothing) {
  auto r = radio({});
  r.set_deaf(1, true);
  EXPECT_FALSE(r(0, 1, 0.0));
  EXPECT_TRUE(r(1, 0, 0.0));
  r.set_deaf(1, false);
  EXPECT_TRUE(r(0, 1, 0.0));
}

}  // namespace
}  // namespace outrider::link
