#pragma once
// Small-sample statistics: means with their intervals, and t-tests.

#include <cstddef>
#include <span>

namespace outrider::report {

struct Interval {
  double lo = 0.0;
  double hi = 0.0;
};

/// Mean and spread of a sample. NaN where the sample is too small for the figure.
struct Moments {
  std::size_t n = 0;
  double mean = 0.0;
  double std = 0.0;  ///< unbiased variance's root (divided by n - 1); NaN for n < 2
};

Moments moments(std::span<const double> sample);

/// Two-sided interval of the mean at `confidence` by Student's t; NaN for n < 2.
Interval mean_interval(const Moments& m, double confidence = 0.95);

/// The p-quantile by linear interpolation between order statistics (Hyndman and Fan's type 7); NaN when empty.
double quantile(std::span<const double> sample, double p);

/// Regularised incomplete beta function I_x(a, b), a, b > 0, x in [0, 1], by the continued fraction of Lentz and
/// Thompson (Press et al., Numerical Recipes, 6.4). Relative error below 1e-10 for a, b up to 1e4.
double incomplete_beta(double a, double b, double x);

/// Two-sided p-value of Student's t with `df` > 0 degrees of freedom (not necessarily whole).
double two_sided_p(double t, double df);

/// The t that a Student variable of `df` degrees of freedom exceeds in absolute value with probability 1 - confidence.
double critical_t(double confidence, double df);

struct TTest {
  double difference = 0.0;  ///< mean of a minus mean of b
  Interval ci95;            ///< of the difference
  double statistic = 0.0;   ///< t; infinite when both samples are constant and differ
  double df = 0.0;
  double p = 1.0;           ///< two-sided
};

/// Welch's test of equal means, unequal variances; needs two values in each sample (else all NaN).
TTest welch_t_test(std::span<const double> a, std::span<const double> b);

/// Paired test: mean of a[i] - b[i] against zero; sizes must be equal (assertion); needs two pairs (else all NaN).
TTest paired_t_test(std::span<const double> a, std::span<const double> b);

}  // namespace outrider::report
