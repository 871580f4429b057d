#include "auction/bid_rules.hpp"

#include <gtest/gtest.h>

#include <random>

namespace outrider::auction {
namespace {

TEST(BidRules, AreThePapersFormulas) {
  const BidTerms t{.u_p1 = 20.0, .u_p2 = -0.5, .d_p = 8.0, .v = 2.0, .a_k = 3.0};
  const BidParameters k{.rho = 0.5, .gamma = 1.0, .weight = 2.0, .alpha = 4.0};
  EXPECT_DOUBLE_EQ(bid_ia(t, k), 20.0 + 2.0 * -0.5 - 0.5 * 8.0);            // eq. 3
  EXPECT_DOUBLE_EQ(bid_ea(t, k), (20.0 - 1.0) / (8.0 / 2.0));               // eq. 5
  EXPECT_DOUBLE_EQ(bid_daa(t, k), (20.0 - 1.0 + 4.0 * 3.0) / (8.0 / 2.0));  // eq. 12
  EXPECT_DOUBLE_EQ(bid_ta(t, k), -8.0);
}

TEST(BidRules, NearerIsBetterForEveryRuleAndEverySignOfTheUtility) {
  for (const char* name : {"ia", "ea", "daa", "ta"}) {
    SCOPED_TRACE(name);
    const BidRule rule = *bid_rule(name);
    for (const double u : {-3.0, 5.0}) {
      const BidTerms near{.u_p1 = u, .d_p = 2.0}, far{.u_p1 = u, .d_p = 9.0};
      EXPECT_GT(rule(near, {}), rule(far, {}));
    }
  }
}

TEST(BidRules, ATaskUnderfootIsFinite) {
  const BidTerms t{.u_p1 = 5.0, .d_p = 0.0, .v = 1.0};
  EXPECT_DOUBLE_EQ(bid_ea(t, {}), 5.0 / kShortestWay);
}

TEST(BidRules, UnknownNamesHaveNoRule) { EXPECT_FALSE(bid_rule("xyz").has_value()); }

// Eq. 8 and 9 are eq. 6, rewritten.
TEST(ExploredRate, RecursionEqualsTheQuotientOfSums) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> area(0.0, 80.0), period(0.05, 12.0);
    ExploredRate rate;
    double sum_a = 0.0, sum_t = 0.0;
    for (int k = 0; k < 200; ++k) {
      const double a = area(random), t = period(random);
      rate.add(a, t);
      sum_a += a;
      sum_t += t;
      ASSERT_NEAR(rate.value(), sum_a / sum_t, 1e-9 * (1.0 + rate.value()));
    }
  }
}

TEST(ExploredRate, IgnoresPeriodsOfNoLength) {
  ExploredRate rate;
  rate.add(5.0, 0.0);
  EXPECT_EQ(rate.value(), 0.0);
  rate.add(6.0, 2.0);
  EXPECT_DOUBLE_EQ(rate.value(), 3.0);
}

}  // namespace
}  // namespace outrider::auction
