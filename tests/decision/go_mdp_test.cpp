// The exact GO-MDP beside slow oracles: plain value iteration over (waypoint, goals), permutations, and roll-outs.

#include "decision/go_mdp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "decision/goal_planner.hpp"
#include "support/topo_maps.hpp"

namespace outrider::decision {
namespace {

using test::random_streets;
using test::random_waypoints;

constexpr double kFar = std::numeric_limits<double>::infinity();

/// J by Jacobi sweeps over all (w, R), from zero, straight from eq. 2 to 5 with all goals achieved as the end.
std::vector<double> plain_value_iteration(const TopologicalMap& map, const std::vector<int>& goals) {
  const std::size_t sets = std::size_t{1} << goals.size(), W = map.waypoints.size();
  std::vector<double> J(W * sets, 0.0), next = J;
  const auto outgoing = map.outgoing();
  const auto goal_bit = [&](int w) -> std::size_t {
    const auto it = std::find(goals.begin(), goals.end(), w);
    return it == goals.end() ? 0 : std::size_t{1} << (it - goals.begin());
  };
  for (double change = 1.0; change > 1e-10;) {
    change = 0.0;
    for (std::size_t R = 1; R < sets; ++R)
      for (std::size_t w = 0; w < W; ++w) {
        double best = kFar;
        if (const std::size_t bit = goal_bit(static_cast<int>(w)); R & bit) best = J[(R & ~bit) * W + w];
        for (const int p : outgoing[w]) {
          const Path& path = map.paths[static_cast<std::size_t>(p)];
          double sum = path.cost;
          for (const Outcome& o : path.outcomes) sum += o.probability * J[R * W + static_cast<std::size_t>(o.waypoint)];
          best = std::min(best, sum);
        }
        next[R * W + w] = best;
        change = std::max(change, std::abs(best - J[R * W + w]));
      }
    std::swap(J, next);
  }
  return J;
}

double cheapest_permutation(const Legs& legs, int start, std::vector<int> goals) {
  std::sort(goals.begin(), goals.end());
  double best = kFar;
  do {
    double sum = legs.from(start, goals[0]);
    for (std::size_t i = 1; i < goals.size(); ++i) sum += legs.between(goals[i - 1], goals[i]);
    best = std::min(best, sum + legs.home_from_goal(goals.back()));
  } while (std::next_permutation(goals.begin(), goals.end()));
  return best;
}

TEST(GoMdp, EqualsPlainValueIterationWithAndWithoutDeviation) {
  for (const double deviation : {0.0, 0.1, 0.3})
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed) + ", deviation " + std::to_string(deviation));
      const TopologicalMap map = random_streets(4, 0.4, deviation, seed);
      std::mt19937_64 random(seed);
      const std::vector<int> goals = random_waypoints(map, 5, random);
      GoMdp mdp(map, goals, {0, 1, 2});
      const std::vector<double> J = plain_value_iteration(map, goals);
      for (std::size_t R = 0; R < 32; ++R)
        for (std::size_t w = 0; w < map.waypoints.size(); ++w) {
          const double expected = J[R * map.waypoints.size() + w];
          EXPECT_NEAR(mdp.cost(static_cast<int>(w), TaskSet(R)), expected, 1e-4 * (1.0 + expected)) << "w " << w << " R " << R;
        }
    }
}

TEST(GoMdp, EqualsTheCheapestPermutationAlsoOnTheWayHome) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const TopologicalMap map = random_streets(5, 0.5, 0.0, seed);
    std::mt19937_64 random(seed);
    const std::vector<int> goals = random_waypoints(map, 7, random);
    const int start = static_cast<int>(random() % map.waypoints.size());
    for (const bool home : {false, true}) {
      GoMdp mdp(map, goals, {start}, home ? std::optional(start) : std::nullopt);
      const double expected = cheapest_permutation(mdp.legs(), start, TaskSet::first(7).members());
      EXPECT_NEAR(mdp.cost(start, TaskSet::first(7)), expected, 1e-4);
      std::vector<int> order = mdp.order(start, TaskSet::first(7));
      double driven = mdp.legs().from(start, order[0]) + mdp.legs().home_from_goal(order.back());
      for (std::size_t i = 1; i < order.size(); ++i) driven += mdp.legs().between(order[i - 1], order[i]);
      EXPECT_NEAR(driven, expected, 1e-4);
      std::sort(order.begin(), order.end());
      EXPECT_EQ(order, TaskSet::first(7).members());
    }
  }
}

TEST(GoMdp, TheWholeTableEqualsSolvingOnDemand) {
  for (const double deviation : {0.0, 0.2}) {
    const TopologicalMap map = random_streets(4, 0.3, deviation, 7);
    std::mt19937_64 random(7);
    const std::vector<int> goals = random_waypoints(map, 8, random);
    GoMdp table(map, goals, {0}), lazy(map, goals, {0});
    table.solve_all();
    EXPECT_EQ(table.sets(), 256U);
    for (std::size_t R = 255; R < 256; R -= 2)
      EXPECT_FLOAT_EQ(static_cast<float>(table.cost(0, TaskSet(R))), static_cast<float>(lazy.cost(0, TaskSet(R))));
  }
}

TEST(GoMdp, RollOutsOfThePolicyCostWhatItExpects) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const TopologicalMap map = random_streets(5, 0.3, 0.3, seed);
    std::mt19937_64 random(seed);
    const std::vector<int> goals = random_waypoints(map, 5, random);
    GoMdp mdp(map, goals, {0});
    const double expected = mdp.cost(0, TaskSet::first(5));
    constexpr int kRuns = 4000;
    double sum = 0.0, squares = 0.0;
    for (int run = 0; run < kRuns; ++run) {
      int w = 0;
      TaskSet R = TaskSet::first(5);
      double cost = 0.0;
      while (true) {
        if (const int g = mdp.legs().goal_at(w); g >= 0) R.erase(g);
        if (R.empty()) break;
        const Path& path = map.paths[static_cast<std::size_t>(mdp.best_path(w, R))];
        cost += path.cost;
        double u = static_cast<double>(random() >> 11) * 0x1p-53;
        for (const Outcome& o : path.outcomes) {
          w = o.waypoint;
          if ((u -= o.probability) < 0.0) break;
        }
      }
      sum += cost;
      squares += cost * cost;
    }
    const double mean = sum / kRuns, sigma = std::sqrt((squares / kRuns - mean * mean) / kRuns);
    EXPECT_NEAR(mean, expected, 5.0 * sigma);
  }
}

TEST(GoMdp, WhatCannotBeReachedCostsInfinity) {
  TopologicalMap map;
  for (const char* id : {"a", "b", "c", "trap"}) map.waypoints.push_back({id, {}, {}, -1});
  map.paths = {certain_path(0, 1, 1.0), certain_path(0, 2, 1.0)};  // one-way: never both b and c
  GoMdp mdp(map, {1, 2}, {0});
  EXPECT_DOUBLE_EQ(mdp.cost(0, TaskSet(1)), 1.0);
  EXPECT_EQ(mdp.cost(0, TaskSet(3)), kFar);
  // A path that may end in a trap is no way at all; the longer one is.
  map.paths = {{0, 1, {}, 1.0, {{1, 0.9}, {3, 0.1}}, {}}, certain_path(0, 2, 5.0), certain_path(2, 1, 5.0)};
  GoMdp wary(map, {1}, {0});
  EXPECT_NEAR(wary.cost(0, TaskSet(1)), 10.0, 1e-4);
  EXPECT_EQ(wary.best_path(0, TaskSet(1)), 1);
}

TEST(GoMdp, MoreThanTwentyGoalsAreSolvedOnDemand) {
  const TopologicalMap map = random_streets(6, 0.3, 0.0, 3);
  std::mt19937_64 random(3);
  const std::vector<int> goals = random_waypoints(map, 30, random);
  GoMdp mdp(map, goals);
  TaskSet set;
  for (const int g : {0, 7, 13, 22, 29}) set.insert(g);
  EXPECT_NEAR(mdp.cost(4, set), cheapest_permutation(mdp.legs(), 4, set.members()), 1e-4);
}

TEST(Tours, AreNeverBelowTheOptimumAndNeverBelowTheBoundButNear) {
  double excess = 0.0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    for (const bool home : {false, true}) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      const TopologicalMap map = random_streets(6, 0.4, 0.0, seed);
      std::mt19937_64 random(seed);
      GoMdp mdp(map, random_waypoints(map, 12, random), {}, home ? std::optional(5) : std::nullopt);
      TourHeuristic tours(mdp.legs());
      const TaskSet all = TaskSet::first(12);
      const auto tour = tours.tour(5, all);
      const double exact = mdp.cost(5, all);
      EXPECT_GE(tour.cost, exact - 1e-4);
      EXPECT_LE(tours.lower_bound(5, all), exact + 1e-4);
      EXPECT_GT(tours.lower_bound(5, all), 0.5 * exact);
      excess += tour.cost / exact - 1.0;
      ++n;
      double driven = mdp.legs().from(5, tour.order[0]) + mdp.legs().home_from_goal(tour.order.back());
      for (std::size_t i = 1; i < tour.order.size(); ++i) driven += mdp.legs().between(tour.order[i - 1], tour.order[i]);
      EXPECT_NEAR(driven, tour.cost, 1e-4);
    }
  EXPECT_LT(excess / n, 0.05);
}

TEST(Tours, WorkWithOneWayStreets) {
  TopologicalMap map = random_streets(5, 0.0, 0.0, 9);
  std::mt19937_64 random(9);
  for (Path& p : map.paths) p.cost *= 0.5 + static_cast<double>(random() % 100) / 50.0;
  GoMdp mdp(map, random_waypoints(map, 9, random));
  ASSERT_FALSE(mdp.legs().symmetric());
  TourHeuristic tours(mdp.legs());
  const TaskSet all = TaskSet::first(9);
  const auto tour = tours.tour(0, all);
  EXPECT_GE(tour.cost, mdp.cost(0, all) - 1e-4);
  EXPECT_LE(tour.cost, 1.3 * mdp.cost(0, all));
  EXPECT_LE(tours.lower_bound(0, all), mdp.cost(0, all) + 1e-4);
}

TEST(GoalPlanner, SwitchesToTheHeuristicAndStaysAFixedFunctionOfTheSet) {
  const TopologicalMap map = random_streets(6, 0.2, 0.0, 4);
  std::mt19937_64 random(4);
  const std::vector<int> goals = random_waypoints(map, 25, random);
  GoalPlanner a(map, goals, {0, 1}, {}), b(map, goals, {0, 1}, {});
  const TaskSet small = TaskSet::first(6), large = TaskSet::first(24);
  EXPECT_TRUE(a.exact(small));
  EXPECT_FALSE(a.exact(large));
  const double first = a.cost(0, large);
  for (int g = 0; g < 25; ++g) b.cost(1, large.without(g % 24));  // another history
  EXPECT_EQ(b.cost(0, large), first);
  EXPECT_LE(a.lower_bound(0, large), first);
  EXPECT_EQ(a.order(0, large).size(), 24U);
}

TEST(Diameter, IsTheLongestShortestPath) {
  TopologicalMap map;
  for (const char* id : {"a", "b", "c"}) map.waypoints.push_back({id, {}, {}, -1});
  map.paths = {certain_path(0, 1, 2.0), certain_path(1, 2, 3.0), certain_path(0, 2, 9.0)};
  EXPECT_DOUBLE_EQ(diameter(map), 5.0);
}

}  // namespace
}  // namespace outrider::decision
