#pragma once
// Worlds to simulate in: a true map, start poses, the usual team. A handful is compiled into the program from
// datasets/*.txt; the same text format is read from files.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "world/grid.hpp"
#include "world/robot.hpp"

namespace outrider::sim {

struct World {
  std::string name;
  std::string provenance;       ///< one line: where the map comes from
  OccupancyGrid map;            ///< the truth; unknown counts as occupied for bodies and sensors
  std::vector<Pose2> starts;    ///< T_map_robot, in the order of preference; may be empty
  std::vector<RobotSpec> team;  ///< the world's usual team, standing on its first starts; may be empty
};

/// One line of `list worlds`.
struct WorldInfo {
  std::string name;
  std::string provenance;
  GridGeometry geometry;
  std::size_t starts = 0;
  std::size_t robots = 0;  ///< in the usual team
  std::string one_line;    ///< "field       100 x 100 m, 100 x 100 cells of 1 m, 16 starts, 4 robots; provenance"
};

/// Names of the compiled-in worlds, sorted.
std::vector<std::string> embedded_worlds();
/// What there is to say about each of them, in the same order. Parses every map: some milliseconds.
std::vector<WorldInfo> embedded_world_infos();
/// Throws InputError, suggesting the nearest names, when there is none of that name.
World embedded_world(std::string_view name);

/// Reads the text format of datasets/ (see datasets/README.md): `key: value` lines, then `map:` and the rows, top row
/// first: `#` wall, `.` free, digits = free start cells 0 to 9. Text without a `map:` line is all map.
/// `source` names the world, and the text in errors (InputError, with the line); `resolution` [m] holds unless the text
/// gives one.
World parse_world(std::string_view text, std::string_view source, double resolution = 1.0);

/// A start pose for each of `radii.size()` robots [m]: the world's own starts in order, then, for the robots left over,
/// the cells nearest by way of free space to any of them (or, if there are none, to the middle of the largest free
/// region) where the disc is clear of walls and of all earlier discs with a tenth of a radius to spare. A start of the
/// world that overlaps an earlier disc is moved the same way; one in a wall or off the map is an InputError that names
/// robot and position, and so is a world without room for everybody. Deterministic.
std::vector<Pose2> spread_starts(const World& world, std::span<const double> radii);

/// Start poses drawn evenly over the cells that all robots can reach from the world's own starts (or, without any, over
/// its largest free region), clear of walls and of one another as above, facing the world's first start's way. The same
/// world, radii and seed give the same poses. Throws InputError when there is no room. O(cells log cells).
std::vector<Pose2> random_starts(const World& world, std::span<const double> radii, std::uint64_t seed);

}  // namespace outrider::sim
