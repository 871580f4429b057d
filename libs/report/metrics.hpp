#pragma once
// Figures that follow from a run record. Each definition is written once, here; docs/metrics.md explains them.

#include <optional>
#include <span>

#include "report/run_record.hpp"

namespace outrider::report {

/// Length of the polyline through the poses [m]. O(n).
double path_length(std::span<const TimedPose> trajectory);

/// Area by how many robots saw it with their own sensors [m^2]; `once` + `twice` + `more` is the explored area.
struct SeenAreas {
  double once = 0.0;
  double twice = 0.0;
  double more = 0.0;  ///< three robots or more
  double sum = 0.0;   ///< of the areas that each robot saw; counts an area seen by k robots k times
  double explored() const { return once + twice + more; }
  /// Area seen by two or more robots / explored area; 0 when nothing was explored.
  double overlap_fraction() const { return explored() > 0.0 ? (twice + more) / explored() : 0.0; }
};

/// How many robots saw each cell, capped at 255; absent unless every robot has a `seen` grid of one geometry.
std::optional<Grid<std::uint8_t>> seen_counts(std::span<const RobotRecord> robots);

/// Absent when `seen_counts` is. O(cells * robots).
std::optional<SeenAreas> seen_areas(std::span<const RobotRecord> robots);

/// Time of the first row that has explored `fraction` [s]; not interpolated.
std::optional<double> time_to(std::span<const TimelineRow> timeline, double fraction);

/// Population standard deviation; 0 for an empty span.
double standard_deviation(std::span<const double> values);

/// The judged cells against the true map: a cell is judged when it is free in truth, or occupied in truth with a
/// free cell among its eight neighbours. The inside of walls, which no sensor sees, counts neither way.
struct MapQuality {
  double iou_occupied = 0.0;  ///< |map and truth occupied| / |map or truth occupied|
  double iou_free = 0.0;      ///< the same for free cells
  double accuracy = 0.0;      ///< of the judged cells that the map knows, the share that is right
  double precision = 0.0;     ///< of the judged cells occupied in the map, the share occupied in truth
  double recall = 0.0;        ///< of the judged cells occupied in truth, the share occupied in the map
};

/// What a cell of the map got wrong.
enum class MapError : std::uint8_t {
  kNone = 0,
  kFalseWall = 1,   ///< occupied in the map, free in truth
  kMissedWall = 2,  ///< free in the map, occupied (and visible) in truth
  kUnseen = 3,      ///< unknown in the map, judged in truth
};

/// The truth is looked up at the centres of the map's cells, so the geometries may differ; cells outside the truth
/// are not judged. O(cells).
Grid<MapError> map_errors(const OccupancyGrid& map, const OccupancyGrid& truth);
MapQuality map_quality(const OccupancyGrid& map, const OccupancyGrid& truth);

/// The `result` section of run.json: what the run itself reported (record.result wins key by key), completed by
/// what can be derived, keys in the documented order.
Json derive_result(const RunRecord& record);

}  // namespace outrider::report
