#pragma once
// Random missions: who starts where and which waypoints are goals.

#include <cstdint>

#include "decision/topo_mission.hpp"

namespace outrider::explorer {

enum class Starts {
  kApart,     ///< each robot at a random waypoint of its own
  kTogether,  ///< all at one random waypoint
};

/// `goals` different waypoints, none of them a start, and the starts of `robots` robots r1, r2, ... Throws InputError when
/// the map has too few waypoints. Deterministic.
decision::TopoMission draw_mission(decision::TopologicalMap map, int goals, int robots, Starts starts, std::uint64_t seed);

}  // namespace outrider::explorer
