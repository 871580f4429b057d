#pragma once
// The control part of Lozenguez et al. 2015, section 3.2: immediate answers to the local situation.

#include <optional>

#include "decision/local_model.hpp"

namespace outrider::decision {

/// Heads for a target in the robot frame. Where an obstacle is in the way there is a candidate beside it on the left and
/// one on the right; the least deviation wins.
struct ReachingController {
  double radius = 0.2;       ///< of the robot [m]
  double margin = 0.1;       ///< kept beyond it where there is room [m]
  double look_ahead = 1.2;   ///< obstacles farther away do not count yet [m]
  double steady = 0.15;      ///< weight of keeping the heading against the least deviation

  /// The heading to take now, robot frame [rad]; nothing: walled in. `last`: heading taken before, robot frame.
  /// O(points log points).
  std::optional<double> heading(const LocalView& model, Point target, std::optional<double> last = {}) const;

 private:
  std::optional<double> free_heading(const LocalView& model, Point target, double clear, std::optional<double> last) const;
};

/// Through an exit: its middle is the target. Needs no odometry.
struct TopologicalController {
  ReachingController reach;
  /// `exit`: index in model.exits (assertion).
  std::optional<double> heading(const LocalView& model, std::size_t exit, std::optional<double> last = {}) const;
};

/// The exit whose bearing is nearest to `bearing` [rad, robot frame].
std::optional<std::size_t> exit_towards(const LocalView& model, double bearing);

}  // namespace outrider::decision
