#pragma once
// Continuous coordination (Lozenguez et al. 2015, section 4.1): one task a robot at a time, the others stay on sale.

#include <functional>
#include <vector>

namespace outrider::auction {

/// What it costs robot i to get to a task from where it is: the place of task `from`, or its start when that is -1 [s].
/// Infinity: no way.
using Leg = std::function<double(int robot, int from, int task)>;

struct ContinuousResult {
  std::vector<std::vector<int>> order;  ///< of each robot
  std::vector<double> driven;           ///< by each robot, until its last task [s]; robots never wait
  int auctions = 0;
  std::size_t messages = 0;  ///< utilities told
};

/// Simultaneous Auctions over the tasks that nobody has, at the beginning and each time that a robot finishes its task.
/// Only free robots bid (eq. 6), from where they are; busy ones keep their task. O(|G|^2 n).
ContinuousResult continuous_coordination(int robots, int tasks, const Leg& leg);

}  // namespace outrider::auction
