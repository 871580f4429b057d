#pragma once
// Maps in files: ROS map_server, images, MRPT grid maps, MovingAI, ASCII, OctoMap. Images are flipped here and
// nowhere else: in memory row 0 is at the bottom.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "world/grid.hpp"

namespace outrider::slam_glue {

struct LoadedMap {
  OccupancyGrid grid;
  std::vector<Point> starts;  ///< centres of the digit cells of an ASCII map, in digit order [m]
};

struct MapLoadOptions {
  /// Edge of a cell [m], for images, MovingAI and ASCII maps. Default 1.0 for .map and .txt; an image without it is
  /// an InputError. Maps that state their own resolution ignore it.
  std::optional<double> resolution;
};

/// Reads a map; the suffix chooses the format:
///  .yaml .yml            ROS map_server (modes trinary, scale and raw; an origin with a yaw is refused)
///  .png .pgm .jpg .bmp   bright (>= 128) or fully transparent = free, dark = occupied; needs a resolution
///  .gridmap .gridmap.gz  MRPT COccupancyGridMap2D
///  .map                  MovingAI
///  .txt                  ASCII, see ascii_map
/// Throws InputError naming the file (and line or key) for anything that is missing or malformed.
LoadedMap load_map(const std::filesystem::path& file, const MapLoadOptions& options = {});

/// '#' wall, '.' or ' ' free, '?' unknown, digits = free start cells. The first line is the top row; lower-left corner
/// at (0, 0); shorter lines are filled up with unknown cells. `starts` (may be null) receives the start cells' centres
/// in digit order. Throws InputError naming `name_for_errors` and the line.
OccupancyGrid ascii_map(std::string_view text, double resolution, std::vector<Point>* starts,
                        const std::string& name_for_errors);

// Writers throw std::runtime_error naming the file when it cannot be written completely.

/// Writes NAME.yaml and NAME.pgm beside it: 254 free, 205 unknown, 0 occupied, occupied_thresh 0.65, free_thresh 0.196.
void save_ros_map(const OccupancyGrid& map, const std::filesystem::path& yaml);

/// An MRPT COccupancyGridMap2D archive, gzip-compressed when the name ends in .gz.
void save_gridmap(const OccupancyGrid& map, const std::filesystem::path& file);

/// A binary OctoMap (.bt): one layer of leaves at height `z` [m]. O(known cells * log).
void save_octomap(const OccupancyGrid& map, const std::filesystem::path& bt, double z);

}  // namespace outrider::slam_glue
