#pragma once
// Allocations of several tasks a robot, and what they are worth (Lozenguez et al. 2015, section 4).

#include <functional>
#include <limits>
#include <vector>

#include "world/task_set.hpp"

namespace outrider::auction {

inline constexpr double kImpossible = std::numeric_limits<double>::infinity();

/// G = <G_1, ..., G_n>: the tasks of each robot.
using Allocation = std::vector<TaskSet>;

/// What a set of tasks costs a robot. It is the part of the expected gain that matters: gn_i(S) = r_g |S| - burden_i(S).
/// The reward r_g exceeds whatever one task more can cost (section 5.2), so it cancels from every comparison but that
/// between doing a task and leaving it, which doing wins. kImpossible: the robot cannot do the set.
/// A protocol needs a fixed function of (robot, tasks).
using Burden = std::function<double(int robot, const TaskSet& tasks)>;

/// What a protocol allocates.
struct BundleProblem {
  int robots = 0;
  int tasks = 0;
  Burden burden;
  double epsilon = 1e-9;  ///< improvements up to this are rounding
};

/// r_g - u_i(G_i, g), eq. 9: what g costs on top of the rest of `mine`, whether or not g is in it already.
double price(const BundleProblem& problem, int robot, const TaskSet& mine, int task);

/// The sum of eq. 10, 0 + 1 + ... + |gs* - size|. gs* need not be whole (|G| / n); we sum up to the floor of the
/// difference, so that the sizes next to gs* cost nothing.
double social_cost(double ideal_size, int size);

/// Eq. 10: J_i(S) + oc * social_cost(gs*, |S|).
Burden altruistic(Burden cost, double opportunity_cost, double ideal_size);

/// s (J_i(S) / s)^p: its sum over the robots tends to the longest mission as p grows, and it is as good a gain for SSA
/// as any. `scale` s > 0: about one robot's fair share.
Burden power_mean(Burden cost, double scale, double power = 8.0);

/// -value(G), eq. 7, without the rewards. Infinite when a robot has tasks that it cannot do.
double total_burden(const BundleProblem& problem, const Allocation& allocation);

/// Tasks that nobody has.
TaskSet unallocated(const Allocation& allocation, int tasks);

/// Ways to begin (step 2 of SSA).
Allocation empty_allocation(const BundleProblem& problem);
/// Each task to a random robot that can do it. Seeded.
Allocation random_allocation(const BundleProblem& problem, std::uint64_t seed);
/// Each task to the robot to which it alone costs least.
Allocation nearest_allocation(const BundleProblem& problem);

}  // namespace outrider::auction
