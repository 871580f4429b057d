#pragma once
// How good a map is, measured against the true one (docs/metrics.md).

#include <cstdint>
#include <vector>

#include "world/grid.hpp"

namespace outrider::report {

/// Of a list of distances [m]; all zero for an empty list.
struct Distances {
  double mean = 0.0, median = 0.0, max = 0.0;
  std::size_t count = 0;
};

/// A cell of the truth is judged when it is free, or occupied with a free cell among its eight neighbours: the inside
/// of walls, which no sensor sees, counts neither way.
struct MapQuality {
  double iou_occupied = 0.0;  ///< |map and truth occupied| / |map or truth occupied|
  double iou_free = 0.0;      ///< the same for free cells
  double accuracy = 0.0;      ///< of the judged cells that the map knows, the share that is right
  double precision = 0.0;     ///< of the judged cells occupied in the map, the share occupied in truth
  double recall = 0.0;        ///< of the judged cells occupied in truth, the share occupied in the map
  double completeness = 0.0;  ///< of the judged cells, the share that the map knows
  double tolerance_m = 0.0;
  double precision_within = 0.0;  ///< of the map's walls, the share with a true wall within the tolerance
  double recall_within = 0.0;     ///< of the judged true walls, the share with a wall of the map within the tolerance
  double recall_seen = 0.0;       ///< the same over those true walls that the map knows anything next to
  Distances wall_to_truth;        ///< from every wall cell of the map to the nearest true wall
  Distances truth_to_wall;        ///< from every true wall the map knows anything next to, to its nearest wall
};

inline constexpr double kUsualTolerance = 0.1;  ///< [m]

/// `map` as it looks on `geometry`: of the map's cells under a cell, a wall counts most, then free space. Cells that the
/// map does not cover are unknown. `T_target_map` maps the map's frame into that of `geometry`. O(cells).
OccupancyGrid resampled(const OccupancyGrid& map, const GridGeometry& geometry, const Pose2& T_target_map);

/// Compares on the truth's cells; a map of another geometry is resampled first. Tolerances below a cell's edge are
/// raised to it. O(cells).
MapQuality map_quality(const OccupancyGrid& map, const OccupancyGrid& truth, const Pose2& T_truth_map = {},
                       double tolerance_m = kUsualTolerance);

/// What a cell of the map got wrong.
enum class MapError : std::uint8_t {
  kNone = 0,
  kFalseWall = 1,   ///< occupied in the map, free in truth
  kMissedWall = 2,  ///< free in the map, occupied (and visible) in truth
  kUnseen = 3,      ///< unknown in the map, judged in truth
};

/// On the map's own cells: the truth is looked up at their centres; cells outside the truth are not judged. O(cells).
Grid<MapError> map_errors(const OccupancyGrid& map, const OccupancyGrid& truth, const Pose2& T_truth_map = {});

}  // namespace outrider::report
