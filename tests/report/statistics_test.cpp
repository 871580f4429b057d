#include "report/statistics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace outrider::report {
namespace {

// Dai, Yao, Zhao 2014, table 2: exploration times of DAA-A and EA-A.
constexpr std::array<double, 20> kDaa{173, 137, 163, 163, 151, 159, 174, 159, 130, 139,
                                      165, 171, 179, 157, 152, 141, 144, 140, 159, 156};
constexpr std::array<double, 20> kEa{217, 207, 184, 186, 207, 258, 178, 237, 196, 227,
                                     176, 170, 210, 203, 210, 198, 216, 206, 181, 201};

TEST(Statistics, MeanAndVarianceOfThePublishedTimes) {
  const Moments m = moments(kDaa);
  EXPECT_NEAR(m.mean, 155.6, 1e-12);
  EXPECT_NEAR(m.std * m.std, 187.5, 0.05);  // as printed in table 4
}

TEST(Statistics, WelchTestOfThePublishedTimes) {
  const TTest t = welch_t_test(kDaa, kEa);
  EXPECT_NEAR(t.statistic, -8.3424, 5e-5);  // as printed in table 5
  EXPECT_NEAR(t.df, 32.0973, 5e-5);
  EXPECT_LT(t.p, 1e-8);
}

/// P(|T| > t) in closed form for one, two and four degrees of freedom.
TEST(Statistics, TDistributionInClosedForm) {
  for (const double t : {0.01, 0.5, 1.0, 2.0, 12.7, 300.0}) {
    EXPECT_NEAR(two_sided_p(t, 1.0), 1.0 - 2.0 / M_PI * std::atan(t), 1e-13) << t;
    EXPECT_NEAR(two_sided_p(t, 2.0), 1.0 - t / std::sqrt(2.0 + t * t), 1e-13) << t;
    const double s = t / std::sqrt(4.0 + t * t);
    EXPECT_NEAR(two_sided_p(t, 4.0), 1.0 - s * (3.0 - s * s) / 2.0, 1e-12) << t;
    EXPECT_EQ(two_sided_p(t, 7.3), two_sided_p(-t, 7.3));
  }
  EXPECT_EQ(two_sided_p(0.0, 5.0), 1.0);
}

TEST(Statistics, CriticalValuesOfTables) {  // any table of the t distribution
  EXPECT_NEAR(critical_t(0.95, 1.0), 12.7062, 1e-4);
  EXPECT_NEAR(critical_t(0.95, 10.0), 2.22814, 1e-5);
  EXPECT_NEAR(critical_t(0.99, 19.0), 2.86093, 1e-5);
  EXPECT_NEAR(critical_t(0.95, 1e7), 1.95996, 1e-5);
}

/// I_x(a, b) against a sum over the binomial distribution, for whole a and b.
TEST(Statistics, IncompleteBetaIsABinomialTail) {
  for (const int a : {1, 2, 5, 40})
    for (const int b : {1, 3, 17})
      for (const double x : {0.0, 0.02, 0.3, 0.5, 0.9, 1.0}) {
        const int n = a + b - 1;
        double tail = 0.0;
        for (int k = a; k <= n; ++k)
          tail += std::exp(std::lgamma(n + 1.0) - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0)) * std::pow(x, k) *
                  std::pow(1.0 - x, n - k);
        EXPECT_NEAR(incomplete_beta(a, b, x), tail, 1e-11) << a << ' ' << b << ' ' << x;
      }
}

TEST(Statistics, PairedTestIgnoresWhatPairsShare) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 1.0), level(0.0, 100.0);
  std::vector<double> a, b;
  for (int i = 0; i < 50; ++i) {
    const double shared = level(random);
    a.push_back(shared + 2.0 + noise(random));
    b.push_back(shared + noise(random));
  }
  EXPECT_LT(paired_t_test(a, b).p, 1e-6);
  EXPECT_GT(welch_t_test(a, b).p, 0.5);
}

/// Under the null hypothesis p is uniform: 5 % of tests are below 0.05.
TEST(Statistics, PValuesAreUniformUnderTheNull) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> wide(5.0, 3.0), narrow(5.0, 0.5);
  int paired = 0, welch = 0, covered = 0;
  constexpr int kTests = 4000;
  for (int k = 0; k < kTests; ++k) {
    std::vector<double> a, b;
    for (int i = 0; i < 8; ++i) a.push_back(wide(random)), b.push_back(narrow(random));
    paired += paired_t_test(a, b).p < 0.05;
    welch += welch_t_test(a, b).p < 0.05;
    const Interval ci = mean_interval(moments(a));
    covered += ci.lo <= 5.0 && 5.0 <= ci.hi;
  }
  EXPECT_NEAR(paired / double(kTests), 0.05, 0.015);
  EXPECT_NEAR(welch / double(kTests), 0.05, 0.015);
  EXPECT_NEAR(covered / double(kTests), 0.95, 0.015);
}

TEST(Statistics, ConstantSamples) {
  const std::vector<double> ones{1.0, 1.0, 1.0}, twos{2.0, 2.0, 2.0};
  EXPECT_EQ(paired_t_test(ones, ones).p, 1.0);
  EXPECT_EQ(paired_t_test(ones, twos).p, 0.0);
  EXPECT_EQ(welch_t_test(ones, ones).p, 1.0);
  EXPECT_EQ(welch_t_test(ones, twos).p, 0.0);
  const std::vector<double> one{1.0};
  EXPECT_TRUE(std::isnan(paired_t_test(one, one).p));
  EXPECT_TRUE(std::isnan(mean_interval(moments(one)).lo));
}

TEST(Statistics, QuantilesInterpolate) {
  const std::vector<double> v{4.0, 1.0, 3.0, 2.0};
  EXPECT_DOUBLE_EQ(quantile(v, 0.0), 1.0);
  EXPECT_DOUBLE_EQ(quantile(v, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile(v, 1.0), 4.0);
}

}  // namespace
}  // namespace outrider::report
