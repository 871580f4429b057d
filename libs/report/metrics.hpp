#pragma once
// Figures that follow from a run record. Each definition is written once, here; docs/metrics.md explains them.

#include <optional>
#include <span>

#include "report/map_quality.hpp"
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

/// Area that two robots both saw with their own sensors.
struct PairOverlap {
  std::size_t a = 0, b = 0;  ///< robots, a < b
  double m2 = 0.0;
  double share_of_smaller = 0.0;  ///< of the area that the robot that saw less has seen
};
/// Every pair, in the order of the team; absent when `seen_counts` is. O(cells * robots + robots^2), and
/// what k robots saw counts k^2 / 2 times.
std::optional<std::vector<PairOverlap>> pair_overlaps(std::span<const RobotRecord> robots);

/// Distance that each robot drove in rows of the timeline in which it added nothing to what the team has seen [m]; empty
/// when the timeline does not know the robots' areas. Trajectories may have a clock of their own (page_data.hpp).
std::vector<double> wasted_m(const RunRecord& record);

/// Time of the first row that has explored `fraction` [s]; not interpolated.
std::optional<double> time_to(std::span<const TimelineRow> timeline, double fraction);

/// Population standard deviation; 0 for an empty span.
double standard_deviation(std::span<const double> values);

/// The `result` section of run.json: what the run itself reported (record.result wins key by key), completed by
/// what can be derived, keys in the documented order.
Json derive_result(const RunRecord& record);

}  // namespace outrider::report
