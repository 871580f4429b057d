#pragma once
// The Local Interpreter of Lozenguez et al. 2015, section 3.1: from a scan to obstacles, exits and a semantic state.

#include <vector>

#include "decision/topological_map.hpp"
#include "world/scan.hpp"

namespace outrider::decision {

/// What stands around the robot, as far as a robot cannot pass between its points. Robot frame [m].
struct Obstacle {
  std::vector<Point> polygon;  ///< in the order of the beams, from the right to the left
};

/// A way out of the local area.
struct Exit {
  double bearing = 0.0;  ///< of its middle, robot frame [rad]
  Point middle;          ///< what the Topological Controller heads for [m]
  double width = 0.0;    ///< between the obstacles beside it [m]; of an open exit, the range
  bool open = false;     ///< nothing on the other side: one obstacle delimits it; regular: two do
};

struct LocalView {
  std::vector<Obstacle> obstacles;
  std::vector<Exit> exits;  ///< from the robot's left to its right, beginning behind it
  SemanticState state = SemanticState::kFreeSpace;
};

struct LocalInterpreter {
  double range = 3.0;       ///< of the local area [m]
  double passage = 0.6;     ///< narrowest gap that the robot may take [m]
  double open_angle = 2.6;  ///< a gap wider than this is open [rad]

  /// `scan`: beams all around, counter-clockwise, from a sensor at the robot's centre. O(beams).
  LocalView operator()(const LaserScan& scan) const;
};

/// The eight states of Fig. 2c. docs/missions.md has our reading of the figure.
SemanticState state_of(std::size_t obstacles, const std::vector<Exit>& exits);

}  // namespace outrider::decision
