#include "auction/bid_rules.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace outrider::auction {
namespace {

double utility(const BidTerms& t, const BidParameters& k) { return t.u_p1 + k.weight * t.u_p2; }  // eq. 1

/// Expected efficiency. A negative utility divided by a time would reward far tasks; multiplying by the time instead
/// keeps the order "nearer is better" on both sides of zero.
double efficiency(double u, const BidTerms& t) {
  const double t_p = std::max(t.d_p, kShortestWay) / t.v;
  return u >= 0.0 ? u / t_p : u * t_p;
}

}  // namespace

double bid_ia(const BidTerms& t, const BidParameters& k) { return utility(t, k) - k.rho * t.d_p; }

double bid_ea(const BidTerms& t, const BidParameters& k) { return efficiency(utility(t, k), t); }

double bid_daa(const BidTerms& t, const BidParameters& k) { return efficiency(utility(t, k) + k.alpha * t.a_k, t); }

double bid_ta(const BidTerms& t, const BidParameters& k) {
  return k.ta == TaUtility::kConstant ? -t.d_p : t.u_p1 - k.rho * t.d_p;
}

std::optional<BidRule> bid_rule(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, BidRule>, 4> kRules{
      {{"ia", bid_ia}, {"ea", bid_ea}, {"daa", bid_daa}, {"ta", bid_ta}}};
  for (const auto& [known, rule] : kRules)
    if (known == name) return rule;
  return std::nullopt;
}

void ExploredRate::add(double delta_a, double period) {
  if (period <= 0.0) return;
  if (p_ == 0.0) {
    a_ = delta_a / period;  // A(1)
  } else {
    a_ = (a_ + delta_a / p_) / (1.0 + period / p_);  // eq. 8
  }
  p_ += period;  // eq. 9
}

}  // namespace outrider::auction
