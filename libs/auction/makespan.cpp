#include "auction/makespan.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include "auction/ssa.hpp"

namespace outrider::auction {
namespace {

int allocated(const Allocation& allocation) {
  return std::accumulate(allocation.begin(), allocation.end(), 0, [](int n, const TaskSet& s) { return n + s.size(); });
}

/// The missions' lengths compared longest first; the total decides between equals.
bool shorter(std::vector<double> a, std::vector<double> b, double epsilon) {
  std::sort(a.rbegin(), a.rend());
  std::sort(b.rbegin(), b.rend());
  for (std::size_t k = 0; k < a.size(); ++k)
    if (std::abs(a[k] - b[k]) > epsilon) return a[k] < b[k];
  return false;
}

void measure(Plan& plan, const std::vector<double>& burden) {
  plan.makespan = burden.empty() ? 0.0 : *std::max_element(burden.begin(), burden.end());
  plan.total = std::accumulate(burden.begin(), burden.end(), 0.0);
}

}  // namespace

bool better(const Plan& a, const Plan& b) {
  if (allocated(a.allocation) != allocated(b.allocation)) return allocated(a.allocation) > allocated(b.allocation);
  if (a.makespan != b.makespan) return a.makespan < b.makespan;
  if (a.total != b.total) return a.total < b.total;
  return a.allocation < b.allocation;
}

MakespanSearch::MakespanSearch(const BundleProblem& problem, std::uint64_t seed, std::vector<char> able)
    : problem_(problem), seed_(seed), able_(std::move(able)) {
  problem_.burden = [burden = problem.burden, able = able_](int i, const TaskSet& tasks) {
    return able[static_cast<std::size_t>(i)] || tasks.empty() ? burden(i, tasks) : kImpossible;
  };
}

Plan MakespanSearch::begin(int start) const {
  if (start == 0) {
    double alone = 0.0;  // the dearest single task: a scale that needs no tour
    for (int i = 0; i < problem_.robots; ++i)
      for (int g = 0; g < problem_.tasks; ++g)
        if (const double b = problem_.burden(i, TaskSet{}.with(g)); b != kImpossible) alone = std::max(alone, b);
    BundleProblem smooth = problem_;
    smooth.burden = power_mean(problem_.burden, std::max(alone, problem_.epsilon));
    return {ssa(smooth, empty_allocation(problem_)).allocation};
  }
  std::mt19937_64 random(seed_ * 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(start));
  std::vector<int> order(static_cast<std::size_t>(problem_.tasks));
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t k = order.size(); k > 1; --k) std::swap(order[k - 1], order[random() % k]);
  Plan plan{empty_allocation(problem_)};
  for (const int g : order) {
    std::size_t best = plan.allocation.size();
    double least = kImpossible;
    for (std::size_t i = 0; i < plan.allocation.size(); ++i)
      if (const double b = problem_.burden(static_cast<int>(i), plan.allocation[i].with(g)); b < least) least = b, best = i;
    if (best < plan.allocation.size()) plan.allocation[best].insert(g);
  }
  return plan;
}

Plan MakespanSearch::search(int start) const {
  Plan plan = begin(start);
  std::vector<double> burden;
  for (int i = 0; i < problem_.robots; ++i) burden.push_back(problem_.burden(i, plan.allocation[static_cast<std::size_t>(i)]));
  while (relieve(plan, burden)) {}
  measure(plan, burden);
  return plan;
}

/// The best move or swap of one task of the robot with the longest mission.
bool MakespanSearch::relieve(Plan& plan, std::vector<double>& burden) const {
  const auto longest = static_cast<std::size_t>(std::max_element(burden.begin(), burden.end()) - burden.begin());
  std::vector<double> best = burden;
  TaskSet best_longest, best_other;
  std::size_t best_robot = longest;
  const auto consider = [&](std::size_t other, const TaskSet& mine, const TaskSet& theirs) {
    std::vector<double> next = burden;
    next[longest] = problem_.burden(static_cast<int>(longest), mine);
    if (next[longest] > burden[longest] - problem_.epsilon) return;
    next[other] = problem_.burden(static_cast<int>(other), theirs);
    if (!shorter(next, best, problem_.epsilon)) return;
    best = std::move(next);
    best_longest = mine, best_other = theirs, best_robot = other;
  };
  const TaskSet mine = plan.allocation[longest];
  for (std::size_t other = 0; other < burden.size(); ++other) {
    if (other == longest) continue;
    const TaskSet theirs = plan.allocation[other];
    mine.for_each([&](int g) {
      consider(other, mine.without(g), theirs.with(g));
      theirs.for_each([&](int h) { consider(other, mine.without(g).with(h), theirs.without(h).with(g)); });
    });
  }
  if (best_robot == longest) return false;
  plan.allocation[longest] = best_longest;
  plan.allocation[best_robot] = best_other;
  burden = std::move(best);
  return true;
}

Plan least_makespan(const BundleProblem& problem, std::uint64_t seed, int starts) {
  const MakespanSearch all(problem, seed, std::vector<char>(static_cast<std::size_t>(problem.robots), 1));
  Plan best = all.search(0);
  for (int k = 1; k < starts; ++k)
    if (Plan plan = all.search(k); better(plan, best)) best = std::move(plan);
  return best;
}

}  // namespace outrider::auction
