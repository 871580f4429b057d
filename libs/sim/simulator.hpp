#pragma once
// A small honest world: a true map, round bodies that follow way-points, sensors. Reproducible from a seed.

#include <cstdint>
#include <memory>
#include <vector>

#include "world/body.hpp"
#include "world/grid.hpp"
#include "world/robot.hpp"

namespace outrider::sim {

struct SimOptions {
  double dt = 0.1;           ///< length of a step [s]
  bool lidar = false;        ///< laser scans instead of the cell sensor
  double scan_rate = 10.0;   ///< [Hz]; a step is divided when it holds several scans
  double range_noise = 0.0;  ///< standard deviation of a lidar range [m]
  std::uint64_t seed = 1;    ///< of the range noise; every robot draws from a stream of its own
};

/// The team in its true world.
///
/// Motion. Each body drives along its polyline exactly, at its own speed; turning takes no time (theta is the direction
/// of travel). Within a step robots move one after the other, in the order of their ids. A move ends early
/// (Sensing::blocked) where the disc would come nearer than touching to another robot's disc, to an occupied or unknown
/// cell's square, or to the edge of the map, all found by exact geometry on the whole way, not by samples. The rest of
/// the path is kept and tried again in the next step. After every step, in all builds, it is checked that no two discs
/// overlap and no disc is in a wall (tolerance 1e-9 m); std::logic_error with full detail otherwise.
///
/// Sensing. Cell sensor: from the cell of the start and from each cell entered on the way, by the rule of
/// sim/visibility.hpp; a cell is reported once to each robot, the truth never changes. Lidar: a scan at time 0 and then
/// at scan_rate, every ray exact up to the face of the first occupied cell; no echo reads range_max. Rays pass through
/// team-mates: real systems know where these are and filter them out. The sensor sits at the robot's centre. A scan's
/// pose is the true pose (perfect localisation). Beams of a full turn are fov / N apart, of a lesser aperture
/// fov / (N - 1). Sightings: team-mates, dead or alive, whose centre is within range and not behind an occupied cell.
///
/// Not thread-safe; one owner. Bodies live as long as the simulator.
class Simulator {
 public:
  /// Throws InputError, naming the robot, for a start in a wall or off the map, two overlapping robots, or a value out
  /// of bounds (radius below 1 mm, negative speed or range, ...).
  Simulator(const OccupancyGrid& truth, std::vector<RobotSpec> team, const SimOptions& options);
  ~Simulator();
  Simulator(Simulator&&) noexcept;
  Simulator& operator=(Simulator&&) noexcept;

  /// The seam to the robot's mind.
  Body& body(RobotId robot);
  /// Advances everybody by dt, sensing on the way.
  void step();

  double now() const;                      ///< [s] since the start
  const Pose2& pose(RobotId robot) const;  ///< T_map_robot
  double path_m(RobotId robot) const;      ///< driven so far [m]
  const std::vector<RobotSpec>& team() const;

  /// Scales the robot's own speed from now on; `factor` >= 0.
  void set_speed_factor(RobotId robot, double factor);
  /// A killed robot neither moves nor senses nor takes commands, and forgets its path; it stays where it is, an
  /// obstacle that its team-mates see as a team-mate.
  void kill(RobotId robot);
  /// Puts a killed robot where it really is: another process drives it (sim/arena.hpp).
  void place(RobotId robot, const Pose2& pose);
  /// A revived robot stands still until it is told where to go.
  void revive(RobotId robot);
  bool alive(RobotId robot) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace outrider::sim
