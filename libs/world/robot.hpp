#pragma once

#include <string>

#include "world/geometry.hpp"

namespace outrider {

/// Index of a robot in its team; the order R_1 ... R_n of the papers.
using RobotId = int;

/// What a robot is able to do. Field names are the keys of a team file.
struct RobotSpec {
  std::string name;            ///< unique in the team, [A-Za-z0-9_-]+
  Pose2 start;                 ///< T_map_robot at time 0
  double speed = 0.5;          ///< [m/s]
  double range = 5.0;          ///< sensing range [m]
  double fov = 2.0 * kPi;      ///< lidar aperture [rad], centred ahead
  int beams = 360;             ///< beams of a lidar scan
  double radius = 0.2;         ///< of the circular body [m]
  friend bool operator==(const RobotSpec&, const RobotSpec&) = default;
};

}  // namespace outrider
