#pragma once
// Topological maps built from occupancy grids (Lozenguez et al. 2015, section 3.3): waypoints at intersections, funnels
// and dead ends, connected by the ways in the middle between the obstacles.

#include "decision/topological_map.hpp"
#include "world/grid.hpp"

namespace outrider::decision {

struct GridTopologyOptions {
  double radius = 0.2;        ///< of the robot [m]
  double funnel_share = 0.6;  ///< a way has a funnel where its clearance falls below this share of what it has on both sides
  double longest_m = 0.0;     ///< longer ways get waypoints between; 0: as long as they are
};

/// The topological map of the largest part of `map` that a robot can drive through. Each path is free of collisions for
/// the robot's disc along its via points; unknown cells count as obstacles; costs are lengths [m]. Waypoints are named
/// w1, w2, ... from the lower left, carry their number as landmark, and look away from the widest gap between their
/// ways, so that exits can be counted from the left. A path's rule is the exit it leaves through (docs/missions.md).
/// Throws InputError when there is no room for the robot.
TopologicalMap topology_of(const OccupancyGrid& map, const GridTopologyOptions& options);

/// Bearings [rad, map frame] in which the paths of `outgoing` leave waypoint `w`.
std::vector<double> exit_bearings(const TopologicalMap& map, int w, const std::vector<int>& outgoing);

/// Where in the order from left to right, for a robot that looks along `theta`, each of these bearings comes.
std::vector<int> left_to_right(const std::vector<double>& bearings, double theta);

}  // namespace outrider::decision
