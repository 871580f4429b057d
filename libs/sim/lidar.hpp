#pragma once

#include <cstdint>
#include <random>

#include "world/geometry.hpp"
#include "world/grid.hpp"
#include "world/robot.hpp"
#include "world/scan.hpp"

namespace outrider::sim {

/// `truth` with nothing unknown and a ring of occupied cells around it, so that rays end at the edge of the map.
OccupancyGrid solid_world(const OccupancyGrid& truth);

/// One robot's laser scanner at the centre of the robot. Its noise comes from a stream of its own, so that no robot's
/// ranges depend on how often another one scans.
class Lidar {
 public:
  /// `noise`: standard deviation of a range [m].
  Lidar(const RobotSpec& robot, double noise, std::uint64_t seed);
  /// The scan from `T_map_robot` in a solid_world. O(beams * cells on a ray).
  LaserScan scan(const OccupancyGrid& solid, const Pose2& T_map_robot, double t);

 private:
  int beams_;
  double fov_, range_, noise_;
  std::mt19937_64 random_;
  std::normal_distribution<double> unit_;
};

}  // namespace outrider::sim
