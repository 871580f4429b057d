#pragma once
// Random allocation problems for tests: robots and tasks in the plane, costs are the shortest tours through a set.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <random>
#include <unordered_map>
#include <vector>

#include "auction/bundles.hpp"
#include "world/geometry.hpp"

namespace outrider::test {

/// J_i(S) by dynamic programming over subsets, memoised.
class PlaneTours {
 public:
  PlaneTours(int robots, int tasks, std::uint64_t seed) : random_(seed) {
    for (int i = 0; i < robots; ++i) starts_.push_back(draw());
    for (int g = 0; g < tasks; ++g) tasks_.push_back(draw());
  }

  double operator()(int robot, const TaskSet& set) {
    double best = set.empty() ? 0.0 : std::numeric_limits<double>::infinity();
    set.for_each([&](int g) {
      best = std::min(best, distance(starts_[static_cast<std::size_t>(robot)], at(g)) + from(g, set.without(g)));
    });
    return best;
  }
  double leg(int robot, int from, int task) const {
    return distance(from < 0 ? starts_[static_cast<std::size_t>(robot)] : at(from), at(task));
  }

 private:
  Point draw() {
    const auto unit = [&] { return static_cast<double>(random_() >> 11U) * 0x1p-53; };
    const double x = unit();
    return {x, unit()};
  }
  const Point& at(int g) const { return tasks_[static_cast<std::size_t>(g)]; }
  double from(int g, const TaskSet& rest) {
    if (rest.empty()) return 0.0;
    const auto [entry, fresh] = memo_.try_emplace(rest.low() << 8U | static_cast<std::uint64_t>(g), 0.0);
    if (!fresh) return entry->second;
    double best = std::numeric_limits<double>::infinity();
    rest.for_each([&](int h) { best = std::min(best, distance(at(g), at(h)) + from(h, rest.without(h))); });
    return memo_[rest.low() << 8U | static_cast<std::uint64_t>(g)] = best;
  }

  std::mt19937_64 random_;
  std::vector<Point> starts_, tasks_;
  std::unordered_map<std::uint64_t, double> memo_;
};

/// The problem of eq. 7 and 10 with noc = 0.1 over the diagonal of the unit square.
inline auction::BundleProblem tour_problem(int robots, int tasks, std::uint64_t seed, bool social = true) {
  const auto tours = std::make_shared<PlaneTours>(robots, tasks, seed);
  const auction::Burden cost = [tours](int i, const TaskSet& set) { return (*tours)(i, set); };
  return {robots, tasks, social ? auction::altruistic(cost, 0.14, static_cast<double>(tasks) / robots) : cost, 1e-9};
}

/// Every third robot cannot do every fourth task.
inline auction::BundleProblem unlike_problem(int robots, int tasks, std::uint64_t seed) {
  auction::BundleProblem problem = tour_problem(robots, tasks, seed);
  problem.burden = [burden = problem.burden](int i, const TaskSet& set) {
    bool able = true;
    set.for_each([&](int g) { able = able && !(i % 3 == 0 && g % 4 == 0); });
    return able ? burden(i, set) : auction::kImpossible;
  };
  return problem;
}

}  // namespace outrider::test
