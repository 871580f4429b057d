#include "sim/lidar.hpp"

#include <algorithm>

#include "world/ray.hpp"

namespace outrider::sim {

OccupancyGrid solid_world(const OccupancyGrid& truth) {
  GridGeometry g = truth.geometry();
  g.origin = {g.origin.x - g.resolution, g.origin.y - g.resolution};
  g.width += 2;
  g.height += 2;
  OccupancyGrid solid(g, CellState::kOccupied);
  for (int y = 0; y < truth.height(); ++y)
    for (int x = 0; x < truth.width(); ++x)
      if (truth[Cell{x, y}] == CellState::kFree) solid[Cell{x + 1, y + 1}] = CellState::kFree;
  return solid;
}

Lidar::Lidar(const RobotSpec& robot, double noise, std::uint64_t seed)
    : beams_(robot.beams), fov_(std::min(robot.fov, 2.0 * kPi)), range_(robot.range), noise_(noise), random_(seed) {}

LaserScan Lidar::scan(const OccupancyGrid& solid, const Pose2& T_map_robot, double t) {
  const bool full_turn = fov_ >= 2.0 * kPi - 1e-9;
  LaserScan scan;
  scan.t = t;
  scan.angle_min = beams_ == 1 ? 0.0 : -0.5 * fov_;
  scan.angle_increment = beams_ == 1 ? 0.0 : fov_ / (full_turn ? beams_ : beams_ - 1);
  scan.range_max = static_cast<float>(range_);  // as ranges are: rounded down they would pass for echoes
  scan.ranges.resize(static_cast<std::size_t>(beams_));
  cast_scan(solid, T_map_robot.position(), T_map_robot.theta + scan.angle_min, scan.angle_increment, scan.ranges,
            range_);
  if (noise_ == 0.0) return scan;
  for (float& range : scan.ranges) {
    const double error = noise_ * unit_(random_);  // drawn for every beam: the stream does not depend on the map
    if (range < scan.range_max) range = static_cast<float>(std::clamp(range + error, 1e-3, range_));
  }
  return scan;
}

}  // namespace outrider::sim
