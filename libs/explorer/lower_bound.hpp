#pragma once

#include <vector>

#include "world/grid.hpp"
#include "world/robot.hpp"

namespace outrider::explorer {

/// A time before which no team of these robots has seen `fraction` of the reachable area, whatever it decides [s].
/// Robots drive from the centre of a cell to that of a neighbour, as Outrider's do; `lidar`: scans instead of the cell
/// sensor.
///
/// Two relaxations joined. By time t nothing is seen but the cells that are near enough to a start: N(t). And a robot
/// newly sees no more than one edge of its footprint a step: c cells a second for the team. For every t0, then, seen(T)
/// <= N(t0) + c (T - t0), and the bound is the largest t0 + (aim - N(t0)) / c. At t0 = 0 this is the area to be seen
/// over the sum of speed and sensing width; at the last t0 it is the farthest cell that somebody must come near.
///
/// O(cells log cells + classes x cells), a class being robots of one speed and range. Robots slowed down or killed only
/// make it looser. `truth` is free or occupied everywhere.
double lower_bound_s(const OccupancyGrid& truth, const std::vector<RobotSpec>& team, double fraction, bool lidar);

}  // namespace outrider::explorer
