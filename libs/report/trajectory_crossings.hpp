#pragma once
// Where the trajectories of different robots cross (the `in` of Dai 2014, table 1).

#include <span>
#include <vector>

#include "world/geometry.hpp"

namespace outrider::report {

struct Crossings {
  std::size_t count = 0;               ///< crossings between different robots, each counted once
  std::vector<std::size_t> per_robot;  ///< those that a robot takes part in; they add up to 2 * count
};

/// Counts the places where one trajectory passes from one side of another to its other side. Meeting and parting on
/// the same side is a touch, not a crossing; a stretch driven along together counts once when it is left on the
/// other side from where it was entered; where a trajectory begins or ends on another it does not cross. Passing the
/// same place twice counts twice. A trajectory's crossings with itself do not count.
///
/// The trajectories are first freed of points within 1 mm of the straight line and rounded to 0.1 mm, so that
/// "on the same line" is exact; coordinates up to 100 km. Segments meet through a uniform grid: about linear in the
/// number of segments plus the number of meetings, for trajectories that do not all run in one place.
Crossings trajectory_crossings(std::span<const std::vector<TimedPose>> trajectories);

}  // namespace outrider::report
