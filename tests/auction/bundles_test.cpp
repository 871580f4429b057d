// The protocols that run without messages, beside enumeration and the paper's own laws.

#include "auction/bundles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "auction/continuous.hpp"
#include "auction/makespan.hpp"
#include "auction/optimal.hpp"
#include "auction/ssa.hpp"
#include "support/tour_problems.hpp"

namespace outrider::auction {
namespace {

using test::tour_problem;
using test::unlike_problem;

TEST(SocialCost, IsNothingAtTheIdealSizeAndGrowsByOneATask) {
  for (int ideal = 0; ideal < 6; ++ideal) EXPECT_EQ(social_cost(ideal, ideal), 0.0);
  EXPECT_EQ(social_cost(3, 4), 1.0);
  EXPECT_EQ(social_cost(3, 5), 1.0 + 2.0);
  EXPECT_EQ(social_cost(3, 0), 1.0 + 2.0 + 3.0);
  EXPECT_EQ(social_cost(10.0 / 3.0, 3), 0.0);  // not whole: both neighbours are free
  EXPECT_EQ(social_cost(10.0 / 3.0, 4), 0.0);
  EXPECT_EQ(social_cost(10.0 / 3.0, 5), 1.0);
}

TEST(Price, IsTheDifferenceOfGains) {  // eq. 9 with r_g = 100
  const BundleProblem problem = tour_problem(2, 5, 1);
  const TaskSet mine = TaskSet(0b00101);
  const auto gain = [&](const TaskSet& s) { return 100.0 * s.size() - problem.burden(1, s); };
  EXPECT_NEAR(100.0 - price(problem, 1, mine, 1), gain(mine.with(1)) - gain(mine), 1e-12);
  EXPECT_NEAR(100.0 - price(problem, 1, mine, 2), gain(mine) - gain(mine.without(2)), 1e-12);
}

/// Algorithm 1 as the paper words it.
TEST(SimultaneousAuctions, ServeTheHighestUtilityFirst) {
  const std::vector<double> utilities{5.0, 9.0, 1.0,   //
                                      8.0, 8.5, -kImpossible};
  EXPECT_EQ(simultaneous_auctions(utilities, 2, 3), (std::vector<Match>{{0, 1}, {1, 0}}));
  EXPECT_TRUE(simultaneous_auctions({}, 0, 3).empty());
}

void expect_sound(const BundleProblem& problem, const Allocation& allocation) {
  for (int g = 0; g < problem.tasks; ++g) {
    const auto owners = std::count_if(allocation.begin(), allocation.end(), [&](const TaskSet& s) { return s.contains(g); });
    bool able = false;
    for (int i = 0; i < problem.robots; ++i) able = able || problem.burden(i, TaskSet{}.with(g)) != kImpossible;
    EXPECT_EQ(owners, able ? 1 : 0) << "task " << g;
  }
  EXPECT_LT(total_burden(problem, allocation), kImpossible);
}

TEST(Ssa, NeverLosesValueAndEndsWhereNoSingleMoveHelps) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const int robots = 1 + static_cast<int>(seed % 5), tasks = static_cast<int>(seed % 11);
    const BundleProblem problem = seed % 3 ? tour_problem(robots, tasks, seed) : unlike_problem(robots, tasks, seed);
    for (const Allocation& initial :
         {empty_allocation(problem), random_allocation(problem, seed), nearest_allocation(problem)}) {
      const SsaResult run = ssa(problem, initial);
      expect_sound(problem, run.allocation);
      double before = total_burden(problem, initial);
      int allocated = tasks - unallocated(initial, tasks).size();
      for (const SsaIteration& iteration : run.iterations) {
        double gains = 0.0;
        std::vector<int> touched(static_cast<std::size_t>(robots), 0);
        for (const TaskMove& move : iteration.moves) {
          gains += move.gain;
          ++touched[static_cast<std::size_t>(move.to)];
          if (move.from) ++touched[static_cast<std::size_t>(*move.from)];
          EXPECT_TRUE(!move.from || move.gain > 0.0);
        }
        for (const int n : touched) EXPECT_LE(n, 1) << "one modification a robot and iteration";
        EXPECT_NEAR(before - iteration.burden, gains, 1e-9) << "the value grows by the sum of the differences";
        EXPECT_GE(iteration.allocated, allocated);
        before = iteration.burden, allocated = iteration.allocated;
      }
      for (int i = 0; i < robots; ++i)
        run.allocation[static_cast<std::size_t>(i)].for_each([&](int g) {
          for (int j = 0; j < robots; ++j)
            if (j != i) {
              EXPECT_LE(price(problem, i, run.allocation[static_cast<std::size_t>(i)], g),
                        price(problem, j, run.allocation[static_cast<std::size_t>(j)], g) + problem.epsilon);
            }
        });
      EXPECT_EQ(ssa(problem, initial).allocation, run.allocation);
    }
  }
}

/// Every way to hand out the tasks.
template <class Value>
double brute_force(const BundleProblem& problem, Value value) {
  double best = kImpossible;
  Allocation allocation = empty_allocation(problem);
  const std::function<void(int)> go = [&](int g) {
    if (g == problem.tasks) {
      best = std::min(best, value(allocation));
      return;
    }
    for (auto& mine : allocation) {
      mine.insert(g);
      go(g + 1);
      mine.erase(g);
    }
  };
  go(0);
  return best;
}

double makespan(const BundleProblem& problem, const Allocation& allocation) {
  double longest = 0.0;
  for (int i = 0; i < problem.robots; ++i)
    longest = std::max(longest, problem.burden(i, allocation[static_cast<std::size_t>(i)]));
  return longest;
}

TEST(OptimalAllocation, EqualsEnumeration) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const BundleProblem problem = tour_problem(1 + static_cast<int>(seed % 3), static_cast<int>(seed % 7), seed, seed % 2);
    const Allocation sum = optimal_allocation(problem, Objective::kSum);
    const Allocation longest = optimal_allocation(problem, Objective::kMakespan);
    expect_sound(problem, sum);
    expect_sound(problem, longest);
    EXPECT_NEAR(total_burden(problem, sum), brute_force(problem, [&](const auto& a) { return total_burden(problem, a); }), 1e-9);
    EXPECT_NEAR(makespan(problem, longest), brute_force(problem, [&](const auto& a) { return makespan(problem, a); }), 1e-9);
  }
}

TEST(OptimalAllocation, LeavesOutWhatNobodyCanDo) {
  const BundleProblem problem = unlike_problem(1, 5, 3);  // robot 0 cannot do tasks 0 and 4
  EXPECT_EQ(optimal_allocation(problem, Objective::kSum)[0], TaskSet(0b01110));
}

TEST(MakespanSearch, IsNeverBetterThanTheOptimumAndClose) {
  double excess = 0.0;
  int n = 0;
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const BundleProblem problem = tour_problem(3, 6 + static_cast<int>(seed % 3), seed, false);
    const Plan plan = least_makespan(problem, seed, 16);
    expect_sound(problem, plan.allocation);
    EXPECT_NEAR(plan.makespan, makespan(problem, plan.allocation), 1e-9);
    const double best = makespan(problem, optimal_allocation(problem, Objective::kMakespan));
    EXPECT_GE(plan.makespan, best - 1e-9);
    excess += plan.makespan / best - 1.0;
    ++n;
  }
  EXPECT_LT(excess / n, 0.02);
}

TEST(Continuous, EverybodyTakesTheNextBestTaskWhenFree) {
  // Robot 0 at 0, robot 1 at 10; tasks at 1, 2, 9, 30.
  const std::vector<double> starts{0.0, 10.0}, places{1.0, 2.0, 9.0, 30.0};
  const auto run = continuous_coordination(2, 4, [&](int i, int from, int g) {
    return std::abs((from < 0 ? starts[static_cast<std::size_t>(i)] : places[static_cast<std::size_t>(from)]) -
                    places[static_cast<std::size_t>(g)]);
  });
  EXPECT_EQ(run.order, (std::vector<std::vector<int>>{{0, 1}, {2, 3}}));
  EXPECT_EQ(run.driven, (std::vector<double>{2.0, 22.0}));
}

TEST(Continuous, DoesEveryTaskOnceAndLeavesTheUnreachable) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    test::PlaneTours tours(3, 8, seed);
    const auto run = continuous_coordination(3, 8, [&](int i, int from, int g) {
      return g == 5 ? kImpossible : tours.leg(i, from, g);
    });
    TaskSet done;
    for (const auto& order : run.order)
      for (const int g : order) {
        EXPECT_FALSE(done.contains(g));
        done.insert(g);
      }
    EXPECT_EQ(done, TaskSet::first(8).without(5)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace outrider::auction
