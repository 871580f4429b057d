#include "auction/optimal.hpp"

#include <algorithm>
#include <cassert>
#include <cstdint>

namespace outrider::auction {
namespace {

using Bits = std::uint32_t;

/// best[i][S]: the least that robots 0 to i can do S for together.
class Enumeration {
 public:
  explicit Enumeration(const BundleProblem& problem) : robots_(static_cast<std::size_t>(problem.robots)) {
    for (int g = 0; g < problem.tasks; ++g)
      for (int i = 0; i < problem.robots; ++i)
        if (problem.burden(i, TaskSet{}.with(g)) != kImpossible) {
          tasks_.push_back(g);
          break;
        }
    sets_ = std::size_t{1} << tasks_.size();
    for (int i = 0; i < problem.robots; ++i)
      for (std::size_t S = 0; S < sets_; ++S) burden_.push_back(problem.burden(i, tasks(static_cast<Bits>(S))));
  }

  /// Fills the table; a robot's share costs at most `cap`.
  double solve(Objective objective, double cap) {
    best_.assign(robots_ * sets_, kImpossible);
    share_.assign(robots_ * sets_, 0);
    for (std::size_t i = 0; i < robots_; ++i)
      for (std::size_t S = 0; S < sets_; ++S) fill(i, static_cast<Bits>(S), objective, cap);
    return best_.back();
  }

  Allocation allocation() const {
    Allocation result(robots_);
    Bits rest = static_cast<Bits>(sets_ - 1);
    for (std::size_t i = robots_; i-- > 0;) {
      const Bits mine = share_[i * sets_ + rest];
      result[i] = tasks(mine);
      rest &= ~mine;
    }
    return result;
  }

 private:
  TaskSet tasks(Bits bits) const {
    TaskSet set;
    for (std::size_t k = 0; k < tasks_.size(); ++k)
      if (bits >> k & 1U) set.insert(tasks_[k]);
    return set;
  }

  void fill(std::size_t i, Bits S, Objective objective, double cap) {
    const double* const mine = &burden_[i * sets_];
    double least = kImpossible;
    Bits share = 0;
    for (Bits T = S;; T = (T - 1) & S) {  // all subsets, the first robot takes everything
      if ((i > 0 || T == S) && mine[T] <= cap) {
        const double others = i > 0 ? best_[(i - 1) * sets_ + (S & ~T)] : 0.0;
        const double value = objective == Objective::kSum ? mine[T] + others : std::max(mine[T], others);
        if (value < least) least = value, share = T;
      }
      if (T == 0) break;
    }
    best_[i * sets_ + S] = least;
    share_[i * sets_ + S] = share;
  }

  std::size_t robots_, sets_ = 1;
  std::vector<int> tasks_;
  std::vector<double> burden_, best_;  // robot x set
  std::vector<Bits> share_;
};

}  // namespace

Allocation optimal_allocation(const BundleProblem& problem, Objective objective) {
  assert(problem.tasks <= kMostForOptimal && problem.robots > 0);
  Enumeration all(problem);
  const double best = all.solve(objective, std::numeric_limits<double>::max());
  if (objective == Objective::kMakespan) all.solve(Objective::kSum, best);
  return all.allocation();
}

}  // namespace outrider::auction
