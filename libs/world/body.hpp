#pragma once
// The seam between one robot's mind (Explorer) and its body: simulated, replayed or real.

#include <span>
#include <vector>

#include "world/grid.hpp"
#include "world/robot.hpp"
#include "world/scan.hpp"

namespace outrider {

/// A cell seen by the cell sensor (`--sensing disc`).
struct SeenCell {
  std::uint32_t index = 0;  ///< in the shared grid geometry
  CellState state = CellState::kUnknown;
};

/// A scan with the pose that localisation gave it.
struct PosedScan {
  Pose2 T_map_robot;
  LaserScan scan;
};

/// A team-mate in view: seen as a team-mate, never mapped as a wall.
struct Sighting {
  RobotId robot = 0;
  Point position;       ///< [m], map frame
  double radius = 0.0;  ///< [m]
};

/// Everything that came in since the last call.
struct Sensing {
  Pose2 pose;                      ///< T_map_robot, now
  std::vector<SeenCell> cells;     ///< disc sensing, along the whole way; may name a cell twice
  std::vector<PosedScan> scans;    ///< lidar sensing
  std::vector<Sighting> sightings; ///< team-mates within sensing range and in line of sight, now
  bool arrived = false;            ///< the end of the commanded path is reached (or there is none)
  bool blocked = false;            ///< the last step was cut short by a team-mate or an obstacle ahead
};

/// A body follows way-points at its own speed and senses. Not thread-safe; one owner.
class Body {
 public:
  virtual ~Body() = default;
  /// What was sensed since the last call. The reference stays valid until the next call.
  virtual const Sensing& sense() = 0;
  /// Drive along the polyline (map frame, metres), beginning at the current position; replaces the previous one.
  /// An empty path stops the body.
  virtual void follow(std::span<const Point> way_points) = 0;
};

}  // namespace outrider
