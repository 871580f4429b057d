#include "auction/bundles.hpp"

#include <cmath>
#include <random>

namespace outrider::auction {

double price(const BundleProblem& problem, int robot, const TaskSet& mine, int task) {
  const double with = problem.burden(robot, mine.with(task));
  return with == kImpossible ? kImpossible : with - problem.burden(robot, mine.without(task));
}

double social_cost(double ideal_size, int size) {
  const double most = std::floor(std::abs(ideal_size - size));
  return most * (most + 1.0) / 2.0;
}

Burden altruistic(Burden cost, double opportunity_cost, double ideal_size) {
  return [=](int robot, const TaskSet& tasks) {
    return cost(robot, tasks) + opportunity_cost * social_cost(ideal_size, tasks.size());
  };
}

Burden power_mean(Burden cost, double scale, double power) {
  return [=](int robot, const TaskSet& tasks) { return scale * std::pow(cost(robot, tasks) / scale, power); };
}

double total_burden(const BundleProblem& problem, const Allocation& allocation) {
  double sum = 0.0;
  for (int i = 0; i < problem.robots; ++i) sum += problem.burden(i, allocation[static_cast<std::size_t>(i)]);
  return sum;
}

TaskSet unallocated(const Allocation& allocation, int tasks) {
  TaskSet rest = TaskSet::first(tasks);
  for (const TaskSet& mine : allocation) mine.for_each([&](int g) { rest.erase(g); });
  return rest;
}

Allocation empty_allocation(const BundleProblem& problem) {
  return Allocation(static_cast<std::size_t>(problem.robots));
}

Allocation random_allocation(const BundleProblem& problem, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  Allocation allocation = empty_allocation(problem);
  for (int g = 0; g < problem.tasks; ++g) {
    std::vector<std::size_t> able;
    for (std::size_t i = 0; i < allocation.size(); ++i)
      if (problem.burden(static_cast<int>(i), TaskSet{}.with(g)) != kImpossible) able.push_back(i);
    if (!able.empty()) allocation[able[random() % able.size()]].insert(g);
  }
  return allocation;
}

Allocation nearest_allocation(const BundleProblem& problem) {
  Allocation allocation = empty_allocation(problem);
  for (int g = 0; g < problem.tasks; ++g) {
    int nearest = -1;
    double least = kImpossible;
    for (int i = 0; i < problem.robots; ++i)
      if (const double p = price(problem, i, {}, g); p < least) least = p, nearest = i;
    if (nearest >= 0) allocation[static_cast<std::size_t>(nearest)].insert(g);
  }
  return allocation;
}

}  // namespace outrider::auction
