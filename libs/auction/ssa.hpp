#pragma once
// Simultaneous Auctions (Algorithm 1) and Sequential Simultaneous Auctions, SSA (Lozenguez et al. 2015, sections 4.1, 5.1).

#include <optional>
#include <span>
#include <vector>

#include "auction/bundles.hpp"

namespace outrider::auction {

struct Match {
  int robot = 0;
  int task = 0;
  friend bool operator==(const Match&, const Match&) = default;
};

/// Algorithm 1: the highest utility is served first, at most one task a robot and one robot a task. `utilities` is
/// robots x tasks, -infinity: no bid. Ties: lower robot, then lower task. O(min(n, m) n m).
std::vector<Match> simultaneous_auctions(std::span<const double> utilities, int robots, int tasks);

/// One task that changes hands.
struct TaskMove {
  int task = 0;
  std::optional<int> from;  ///< nobody: the task was free
  int to = 0;
  double gain = 0.0;  ///< of eq. 7, without the reward r_g of a task that was free
};

struct SsaIteration {
  std::vector<double> prices;   ///< step 3, robots x tasks: r_g - u_i(G_i, g)
  std::vector<TaskMove> moves;  ///< step 4
  int allocated = 0;            ///< tasks that have an owner afterwards
  double burden = 0.0;          ///< -value(G) without rewards, afterwards
};

struct SsaResult {
  Allocation allocation;
  std::vector<SsaIteration> iterations;  ///< the last one has no moves
  std::vector<int> modifications;        ///< of each robot's tasks
  std::size_t messages = 0;              ///< utilities told: n |G| an iteration
};

/// Steps 3 to 5 from `initial` (step 2). Each iteration moves the tasks with the greatest differences of utility, at
/// most one modification a robot, so that value(G) grows by the sum of the differences; ends with an allocation that no
/// single move improves. Deterministic; ties: lower task, then lower robot.
SsaResult ssa(const BundleProblem& problem, Allocation initial);

}  // namespace outrider::auction
