#pragma once
// Ways over a topological map.

#include <vector>

#include "decision/topological_map.hpp"

namespace outrider::decision {

/// The paths (indices) of the cheapest way from one waypoint to another, by costs_to(); empty when there is none, or
/// when it is the same place.
std::vector<int> route(const TopologicalMap& map, int from, int to);

/// The points along a route, the waypoint `from` first [m].
std::vector<Point> route_points(const TopologicalMap& map, int from, const std::vector<int>& paths);

}  // namespace outrider::decision
