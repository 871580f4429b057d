#pragma once
// A multi-task mission on a topological map: who starts where, which waypoints are to be visited.

#include <memory>
#include <string>
#include <vector>

#include "decision/topological_map.hpp"

namespace outrider::decision {

struct TopoRobot {
  std::string name;
  int at = 0;          ///< index of its first waypoint, in its own map
  double speed = 1.0;  ///< divides all costs
  std::vector<int> current;  ///< goals that it already has, as indices of TopoMission::goals
  std::shared_ptr<const TopologicalMap> own;  ///< its own map when it is not the mission's; waypoints match by id
};

struct TopoMission {
  TopologicalMap map;
  std::vector<TopoRobot> robots;
  std::vector<int> goals;  ///< distinct waypoint indices; goal g of the protocols is goals[g]
};

}  // namespace outrider::decision
