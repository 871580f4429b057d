#pragma once

#include <vector>

#include "world/geometry.hpp"

namespace outrider {

/// One sweep of a planar laser scanner. Beam i points to angle_min + i * angle_increment in the sensor frame.
struct LaserScan {
  double t = 0.0;                ///< [s], start of the sweep
  double angle_min = 0.0;        ///< [rad]
  double angle_increment = 0.0;  ///< [rad]; N beams over an aperture A are A / (N - 1) apart
  double range_max = 0.0;        ///< [m]; a beam with range >= range_max (or NaN) saw no echo
  Pose2 T_robot_sensor;          ///< where the sensor sits on the robot
  double sensor_z = 0.0;         ///< height of the scan plane [m]
  std::vector<float> ranges;     ///< [m]

  double angle(std::size_t beam) const { return angle_min + static_cast<double>(beam) * angle_increment; }
  bool valid(std::size_t beam) const { return ranges[beam] > 0.0F && ranges[beam] < range_max; }
};

}  // namespace outrider
