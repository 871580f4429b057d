#include "decision/tours.hpp"

#include <algorithm>
#include <limits>

namespace outrider::decision {
namespace {

constexpr double kGain = 1e-6;  ///< relative improvement that counts; float legs carry no more
constexpr int kAnywhere = -1;   ///< a tour that may begin at any goal

/// An open tour under improvement. Position 0 is the start, behind the last goal comes home (or nothing).
class Improver {
 public:
  Improver(const Legs& legs, int start, std::vector<int> order) : legs_(legs), start_(start), tour_(std::move(order)) {
    least_gain_ = kGain * std::max(1e-9, cost());
  }

  double cost() const {
    double sum = 0.0;
    for (std::size_t i = 0; i <= tour_.size(); ++i) sum += into(i);
    return sum;
  }
  void improve() {
    while (two_opt() || or_opt()) {}
  }
  std::vector<int> take() { return std::move(tour_); }

 private:
  /// Cost of entering position i from the one before; i = size: home.
  double into(std::size_t i) const { return leg(i == 0 ? kStart : tour_[i - 1], i == tour_.size() ? kEnd : tour_[i]); }
  double leg(int from, int to) const {
    if (to == kEnd) return from == kStart ? 0.0 : legs_.home_from_goal(from);
    if (from == kStart) return start_ == kAnywhere ? 0.0 : legs_.from(start_, to);
    return legs_.between(from, to);
  }
  int before(std::size_t i) const { return i == 0 ? kStart : tour_[i - 1]; }
  int after(std::size_t i) const { return i + 1 >= tour_.size() ? kEnd : tour_[i + 1]; }

  /// What tour_[i..j] costs more when driven backwards.
  double reversal(std::size_t i, std::size_t j) const {
    if (legs_.symmetric()) return 0.0;
    double extra = 0.0;
    for (std::size_t k = i; k < j; ++k)
      extra += legs_.between(tour_[k + 1], tour_[k]) - legs_.between(tour_[k], tour_[k + 1]);
    return extra;
  }

  bool two_opt() {
    bool any = false;
    for (std::size_t i = 0; i + 1 < tour_.size(); ++i)
      for (std::size_t j = i + 1; j < tour_.size(); ++j) {
        const double gain = leg(before(i), tour_[i]) + leg(tour_[j], after(j)) - leg(before(i), tour_[j]) -
                            leg(tour_[i], after(j)) - reversal(i, j);
        if (!(gain > least_gain_)) continue;
        std::reverse(tour_.begin() + static_cast<std::ptrdiff_t>(i), tour_.begin() + static_cast<std::ptrdiff_t>(j) + 1);
        any = true;
      }
    return any;
  }

  /// Moves one segment of up to three goals to the best other place, either way round.
  bool or_opt() {
    bool any = false;
    for (std::size_t length = 1; length <= 3 && length < tour_.size(); ++length)
      for (std::size_t i = 0; i + length <= tour_.size(); ++i) any = move_segment(i, length) || any;
    return any;
  }

  bool move_segment(std::size_t i, std::size_t length) {
    const std::size_t j = i + length - 1;
    const double removed =
        leg(before(i), tour_[i]) + leg(tour_[j], after(j)) - leg(before(i), after(j));
    double best = least_gain_;
    std::size_t place = 0;
    bool turned = false, found = false;
    const double turn = reversal(i, j);
    for (std::size_t k = 0; k <= tour_.size(); ++k) {  // in front of position k
      if (k >= i && k <= j + 1) continue;
      const int a = before(k), b = k == tour_.size() ? kEnd : tour_[k];
      const double open = leg(a, b);
      const double straight = removed + open - leg(a, tour_[i]) - leg(tour_[j], b);
      const double back = removed + open - leg(a, tour_[j]) - leg(tour_[i], b) - turn;
      if (straight > best) best = straight, place = k, turned = false, found = true;
      if (length > 1 && back > best) best = back, place = k, turned = true, found = true;
    }
    if (!found) return false;
    const auto at = [&](std::size_t p) { return tour_.begin() + static_cast<std::ptrdiff_t>(p); };
    if (turned) std::reverse(at(i), at(j + 1));
    if (place < i) std::rotate(at(place), at(i), at(j + 1));
    else std::rotate(at(i), at(j + 1), at(place));
    return true;
  }

  static constexpr int kStart = -1, kEnd = -2;
  const Legs& legs_;
  int start_;
  std::vector<int> tour_;
  double least_gain_ = 0.0;
};

}  // namespace

const std::vector<int>& TourHeuristic::guide() {
  if (!guide_.empty() || legs_.goals() == 0) return guide_;
  // Cheapest insertion in the order of the goals' numbers, then improved.
  std::vector<int> order;
  for (int g = 0; g < legs_.goals(); ++g) {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k <= order.size(); ++k) {
      double more = 0.0;
      if (k > 0) more += legs_.between(order[k - 1], g);
      if (k < order.size()) more += legs_.between(g, order[k]);
      if (k > 0 && k < order.size()) more -= legs_.between(order[k - 1], order[k]);
      if (more < least) least = more, best = k;
    }
    order.insert(order.begin() + static_cast<std::ptrdiff_t>(best), g);
  }
  Improver improver(legs_, kAnywhere, std::move(order));
  improver.improve();
  guide_ = improver.take();
  return guide_;
}

TourHeuristic::Tour TourHeuristic::tour(int waypoint, const TaskSet& goals) {
  std::vector<int> forwards;
  for (const int g : guide())
    if (goals.contains(g)) forwards.push_back(g);
  if (forwards.empty()) return {{}, legs_.home(waypoint)};
  std::vector<int> backwards(forwards.rbegin(), forwards.rend());
  Improver a(legs_, waypoint, std::move(forwards)), b(legs_, waypoint, std::move(backwards));
  Improver& better = b.cost() < a.cost() ? b : a;
  better.improve();
  const double cost = better.cost();
  return {better.take(), cost};
}

double TourHeuristic::lower_bound(int waypoint, const TaskSet& goals) const {
  const std::vector<int> members = goals.members();
  std::vector<double> link(members.size());
  std::vector<char> in(members.size(), 0);
  double sum = 0.0, home = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < members.size(); ++i) {
    link[i] = legs_.from(waypoint, members[i]);
    home = std::min(home, static_cast<double>(legs_.home_from_goal(members[i])));
  }
  for (std::size_t round = 0; round < members.size(); ++round) {  // Prim
    std::size_t next = members.size();
    for (std::size_t i = 0; i < members.size(); ++i)
      if (!in[i] && (next == members.size() || link[i] < link[next])) next = i;
    in[next] = 1;
    sum += link[next];
    for (std::size_t i = 0; i < members.size(); ++i)
      link[i] = std::min({link[i], static_cast<double>(legs_.between(members[next], members[i])),
                          static_cast<double>(legs_.between(members[i], members[next]))});
  }
  return sum + (members.empty() ? legs_.home(waypoint) : home);
}

}  // namespace outrider::decision
