#pragma once
// Tours through more goals than the exact GO-MDP can take: a heuristic that depends on the set alone, and a bound.

#include <unordered_map>
#include <vector>

#include "decision/legs.hpp"
#include "world/task_set.hpp"

namespace outrider::decision {

/// Open tours (or tours that end at home) over the legs D(w, g): the order of one good tour through all goals,
/// restricted to the set, then improved by 2-opt and Or-opt (segments of 1 to 3) until nothing helps. A function of
/// (w, set) and of nothing else, which is what the convergence of SSA asks of a gain.
class TourHeuristic {
 public:
  explicit TourHeuristic(const Legs& legs) : legs_(legs) {}

  struct Tour {
    std::vector<int> order;  ///< goals
    double cost = 0.0;       ///< infinity when there is no way
  };
  /// O(|S|^2) a pass, a few passes. Not memoised.
  Tour tour(int waypoint, const TaskSet& goals);
  /// No tour is cheaper: the minimum spanning tree of w and the goals (the cheaper direction of each leg), plus the
  /// cheapest way home. O(|S|^2).
  double lower_bound(int waypoint, const TaskSet& goals) const;

 private:
  const std::vector<int>& guide();

  const Legs& legs_;
  std::vector<int> guide_;  // all goals, in the order of a good tour
};

}  // namespace outrider::decision
