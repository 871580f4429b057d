#include "auction/ssa.hpp"

#include <algorithm>
#include <cassert>

namespace outrider::auction {
namespace {

/// The synchronised protocol: what all robots know after each iteration.
class Ssa {
 public:
  Ssa(const BundleProblem& problem, Allocation initial)
      : problem_(problem), tasks_(static_cast<std::size_t>(problem.tasks)), owner_(tasks_, -1),
        prices_(static_cast<std::size_t>(problem.robots) * tasks_) {
    result_.allocation = std::move(initial);
    result_.modifications.assign(static_cast<std::size_t>(problem.robots), 0);
    for (std::size_t i = 0; i < result_.allocation.size(); ++i)
      result_.allocation[i].for_each([&](int g) { owner_[static_cast<std::size_t>(g)] = static_cast<int>(i); });
  }

  SsaResult run() {
    for (int i = 0; i < problem_.robots; ++i) compute_values(i);
    do {
      result_.messages += prices_.size();
      result_.iterations.push_back({prices_, update(), 0, 0.0});
      SsaIteration& now = result_.iterations.back();
      for (const TaskMove& move : now.moves) {
        compute_values(move.to);
        if (move.from) compute_values(*move.from);
      }
      now.allocated = static_cast<int>(std::count_if(owner_.begin(), owner_.end(), [](int o) { return o >= 0; }));
      now.burden = total_burden(problem_, result_.allocation);
    } while (!result_.iterations.back().moves.empty());
    return std::move(result_);
  }

 private:
  double& price_of(int robot, std::size_t task) { return prices_[static_cast<std::size_t>(robot) * tasks_ + task]; }

  /// Step 3.
  void compute_values(int robot) {
    const TaskSet& mine = result_.allocation[static_cast<std::size_t>(robot)];
    for (std::size_t g = 0; g < tasks_; ++g) price_of(robot, g) = price(problem_, robot, mine, static_cast<int>(g));
  }

  std::vector<TaskMove> candidates() {
    std::vector<TaskMove> moves;
    for (std::size_t g = 0; g < tasks_; ++g)
      for (int i = 0; i < problem_.robots; ++i) {
        if (owner_[g] == i || price_of(i, g) == kImpossible) continue;
        if (owner_[g] < 0) {
          moves.push_back({static_cast<int>(g), std::nullopt, i, -price_of(i, g)});
        } else if (const double gain = price_of(owner_[g], g) - price_of(i, g); gain > problem_.epsilon) {
          moves.push_back({static_cast<int>(g), owner_[g], i, gain});
        }
      }
    std::stable_sort(moves.begin(), moves.end(), [](const TaskMove& a, const TaskMove& b) {
      return a.from.has_value() != b.from.has_value() ? !a.from.has_value() : a.gain > b.gain;
    });
    return moves;
  }

  /// Step 4.
  std::vector<TaskMove> update() {
    std::vector<TaskMove> taken;
    std::vector<char> modified(static_cast<std::size_t>(problem_.robots), 0);
    for (const TaskMove& move : candidates()) {
      char& receiver = modified[static_cast<std::size_t>(move.to)];
      const auto g = static_cast<std::size_t>(move.task);
      if (receiver || owner_[g] != move.from.value_or(-1)) continue;
      if (move.from && modified[static_cast<std::size_t>(*move.from)]) continue;
      receiver = 1;
      if (move.from) {
        modified[static_cast<std::size_t>(*move.from)] = 1;
        result_.allocation[static_cast<std::size_t>(*move.from)].erase(move.task);
        ++result_.modifications[static_cast<std::size_t>(*move.from)];
      }
      owner_[g] = move.to;
      result_.allocation[static_cast<std::size_t>(move.to)].insert(move.task);
      ++result_.modifications[static_cast<std::size_t>(move.to)];
      taken.push_back(move);
    }
    return taken;
  }

  const BundleProblem& problem_;
  std::size_t tasks_;
  std::vector<int> owner_;      // of each task; -1: nobody
  std::vector<double> prices_;  // robots x tasks
  SsaResult result_;
};

}  // namespace

std::vector<Match> simultaneous_auctions(std::span<const double> utilities, int robots, int tasks) {
  assert(utilities.size() == static_cast<std::size_t>(robots) * static_cast<std::size_t>(tasks));
  std::vector<char> robot_taken(static_cast<std::size_t>(robots), 0), task_taken(static_cast<std::size_t>(tasks), 0);
  std::vector<Match> matches;
  while (true) {
    double best = -kImpossible;
    std::optional<Match> match;
    for (int i = 0; i < robots; ++i)
      for (int g = 0; g < tasks; ++g) {
        const double u = utilities[static_cast<std::size_t>(i * tasks + g)];
        if (u > best && !robot_taken[static_cast<std::size_t>(i)] && !task_taken[static_cast<std::size_t>(g)])
          best = u, match = Match{i, g};
      }
    if (!match) return matches;
    robot_taken[static_cast<std::size_t>(match->robot)] = task_taken[static_cast<std::size_t>(match->task)] = 1;
    matches.push_back(*match);
  }
}

SsaResult ssa(const BundleProblem& problem, Allocation initial) { return Ssa(problem, std::move(initial)).run(); }

}  // namespace outrider::auction
