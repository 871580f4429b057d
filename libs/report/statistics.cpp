#include "report/statistics.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

namespace outrider::report {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The continued fraction of I_x(a, b), by Lentz's method; converges fast for x < (a + 1) / (a + b + 2).
double beta_fraction(double a, double b, double x) {
  constexpr double kTiny = 1e-300;
  constexpr int kMostTerms = 10'000;
  const auto away_from_zero = [](double v) { return std::abs(v) < kTiny ? kTiny : v; };
  double c = 1.0;
  double d = 1.0 / away_from_zero(1.0 - (a + b) * x / (a + 1.0));
  double h = d;
  for (int m = 1; m <= kMostTerms; ++m) {
    const double even = m * (b - m) * x / ((a + 2 * m - 1.0) * (a + 2 * m));
    d = 1.0 / away_from_zero(1.0 + even * d);
    c = away_from_zero(1.0 + even / c);
    h *= d * c;
    const double odd = -(a + m) * (a + b + m) * x / ((a + 2 * m) * (a + 2 * m + 1.0));
    d = 1.0 / away_from_zero(1.0 + odd * d);
    c = away_from_zero(1.0 + odd / c);
    h *= d * c;
    if (std::abs(d * c - 1.0) < 1e-15) break;
  }
  return h;
}

/// From the difference of two means, its standard error and degrees of freedom.
TTest t_test(double difference, double standard_error, double df) {
  TTest test{difference, {difference, difference}, 0.0, df, 1.0};
  if (standard_error == 0.0) {  // constant samples: equal, or different beyond doubt
    if (difference != 0.0) {
      test.statistic = std::copysign(std::numeric_limits<double>::infinity(), difference);
      test.p = 0.0;
    }
    return test;
  }
  test.statistic = difference / standard_error;
  test.p = two_sided_p(test.statistic, df);
  const double half = critical_t(0.95, df) * standard_error;
  test.ci95 = {difference - half, difference + half};
  return test;
}

constexpr TTest kTooSmall{kNaN, {kNaN, kNaN}, kNaN, kNaN, kNaN};

}  // namespace

Moments moments(std::span<const double> sample) {
  Moments m{sample.size(), kNaN, kNaN};
  if (sample.empty()) return m;
  const auto n = static_cast<double>(sample.size());
  double sum = 0.0, squares = 0.0;
  for (const double v : sample) sum += v;
  m.mean = sum / n;
  for (const double v : sample) squares += (v - m.mean) * (v - m.mean);
  if (sample.size() > 1) m.std = std::sqrt(squares / (n - 1.0));
  return m;
}

Interval mean_interval(const Moments& m, double confidence) {
  if (m.n < 2) return {kNaN, kNaN};
  const auto n = static_cast<double>(m.n);
  const double half = critical_t(confidence, n - 1.0) * m.std / std::sqrt(n);
  return {m.mean - half, m.mean + half};
}

double quantile(std::span<const double> sample, double p) {
  if (sample.empty()) return kNaN;
  std::vector<double> sorted(sample.begin(), sample.end());
  std::sort(sorted.begin(), sorted.end());
  const double at = p * static_cast<double>(sorted.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  if (low + 1 >= sorted.size()) return sorted.back();
  return sorted[low] + (at - static_cast<double>(low)) * (sorted[low + 1] - sorted[low]);
}

double incomplete_beta(double a, double b, double x) {
  assert(a > 0.0 && b > 0.0 && x >= 0.0 && x <= 1.0);
  if (x == 0.0 || x == 1.0) return x;
  int sign = 0;  // lgamma_r: lgamma would write a global
  const double log_front = lgamma_r(a + b, &sign) - lgamma_r(a, &sign) - lgamma_r(b, &sign) + a * std::log(x) +
                           b * std::log1p(-x);
  const double front = std::exp(log_front);
  if (x < (a + 1.0) / (a + b + 2.0)) return front * beta_fraction(a, b, x) / a;
  return 1.0 - front * beta_fraction(b, a, 1.0 - x) / b;
}

double two_sided_p(double t, double df) {
  if (std::isnan(t) || !(df > 0.0)) return kNaN;
  if (std::isinf(t)) return 0.0;
  return incomplete_beta(df / 2.0, 0.5, df / (df + t * t));
}

double critical_t(double confidence, double df) {
  const double p = 1.0 - confidence;
  double low = 0.0, high = 1.0;
  while (two_sided_p(high, df) > p && high < 1e12) high *= 2.0;
  for (int i = 0; i < 200 && high - low > 1e-13 * high; ++i) {
    const double middle = (low + high) / 2.0;
    (two_sided_p(middle, df) > p ? low : high) = middle;
  }
  return (low + high) / 2.0;
}

TTest welch_t_test(std::span<const double> a, std::span<const double> b) {
  if (a.size() < 2 || b.size() < 2) return kTooSmall;
  const Moments ma = moments(a), mb = moments(b);
  const double na = static_cast<double>(ma.n), nb = static_cast<double>(mb.n);
  const double va = ma.std * ma.std / na, vb = mb.std * mb.std / nb;
  // Welch-Satterthwaite; constant samples leave it undefined, and the pooled figure stands in.
  const double df = va + vb > 0.0 ? (va + vb) * (va + vb) / (va * va / (na - 1.0) + vb * vb / (nb - 1.0)) : na + nb - 2.0;
  return t_test(ma.mean - mb.mean, std::sqrt(va + vb), df);
}

TTest paired_t_test(std::span<const double> a, std::span<const double> b) {
  assert(a.size() == b.size());
  if (a.size() < 2) return kTooSmall;
  std::vector<double> differences(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) differences[i] = a[i] - b[i];
  const Moments m = moments(differences);
  const auto n = static_cast<double>(m.n);
  return t_test(m.mean, m.std / std::sqrt(n), n - 1.0);
}

}  // namespace outrider::report
