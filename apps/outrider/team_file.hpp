#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "sim/world.hpp"
#include "world/robot.hpp"

namespace outrider::app {

/// A team file, read but not yet placed in a world.
struct TeamFile {
  std::vector<RobotSpec> robots;
  std::vector<bool> has_start;  ///< robots without one get the world's start poses
};

/// Reads `robots: [{name, start: [x, y, theta], speed, range, fov, beams, radius}]` (YAML; m, rad, m/s).
/// Throws InputError naming file, line and key.
TeamFile read_team_file(const std::filesystem::path& path);

/// `n` robots for a world: its usual team, repeated with new names when it is too small; without one, Dai 2014's
/// unlike team (speeds 3 : 4 : 3 : 2, ranges 4 : 8 : 3 : 4), in cells when these are coarser than 0.5 m, else scaled to
/// an indoor robot of 0.6 m/s. `n` = 0: the usual size.
TeamFile usual_team(const sim::World& world, int n);

/// Dai 2014's team R1 to R4 for cells of this size: speeds 3, 4, 3, 2 and ranges 4, 8, 3, 4 in cells when these are
/// coarser than 0.5 m, else scaled to an indoor robot of 0.6 m/s. Without starts.
std::vector<RobotSpec> dai_team(double resolution);

/// Gives every robot a start pose. Throws InputError when there is no room.
std::vector<RobotSpec> place_team(const sim::World& world, TeamFile team);

}  // namespace outrider::app
