#include "report/map_quality.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace outrider::report {
namespace {

/// Whether any of the nine cells around `c` satisfies `is`.
template <class Is>
bool any_around(const OccupancyGrid& grid, Cell c, Is&& is) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const Cell n{c.x + dx, c.y + dy};
      if (grid.contains(n) && is(grid[n])) return true;
    }
  return false;
}

bool is_judged(const OccupancyGrid& truth, Cell c) {
  if (!truth.contains(c) || truth[c] == CellState::kUnknown) return false;
  return truth[c] == CellState::kFree || any_around(truth, c, [](CellState s) { return s == CellState::kFree; });
}

double ratio(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

/// From the centre of every cell to that of the nearest occupied one [m]; very far where there is none.
cv::Mat1f distance_to_walls(const OccupancyGrid& grid) {
  cv::Mat1b open(grid.height(), grid.width());
  for (std::size_t i = 0; i < grid.size(); ++i)
    open.data[i] = grid[i] == CellState::kOccupied ? std::uint8_t{0} : std::uint8_t{1};
  cv::Mat1f distance;
  cv::distanceTransform(open, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  distance *= grid.geometry().resolution;
  return distance;
}

Distances summary(std::vector<double> values) {
  if (values.empty()) return {};
  std::sort(values.begin(), values.end());
  return {std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size()),
          values[values.size() / 2], values.back(), values.size()};
}

std::size_t within(const std::vector<double>& values, double most) {
  return static_cast<std::size_t>(std::count_if(values.begin(), values.end(), [&](double v) { return v <= most; }));
}

/// Fills the figures that look at the neighbourhood. `map` has the truth's geometry.
void measure_distances(const OccupancyGrid& map, const OccupancyGrid& truth, MapQuality& q) {
  const bool has_walls = std::count(map.data().begin(), map.data().end(), CellState::kOccupied) > 0;
  const bool has_truth = std::count(truth.data().begin(), truth.data().end(), CellState::kOccupied) > 0;
  const cv::Mat1f to_truth = distance_to_walls(truth), to_map = distance_to_walls(map);
  std::vector<double> ours, theirs;
  std::size_t true_walls = 0, true_found = 0;
  const double tolerance = q.tolerance_m * (1.0 + 1e-6);
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Cell c = map.geometry().cell_at(i);
    if (has_truth && map[i] == CellState::kOccupied && truth[i] != CellState::kUnknown)
      ours.push_back(to_truth(c.y, c.x));
    if (truth[i] != CellState::kOccupied || !is_judged(truth, c)) continue;
    ++true_walls;
    true_found += has_walls && to_map(c.y, c.x) <= tolerance;
    if (has_walls && any_around(map, c, [](CellState s) { return s != CellState::kUnknown; }))
      theirs.push_back(to_map(c.y, c.x));
  }
  q.precision_within = ratio(within(ours, tolerance), ours.size());
  q.recall_within = ratio(true_found, true_walls);
  q.recall_seen = ratio(within(theirs, tolerance), theirs.size());
  q.wall_to_truth = summary(std::move(ours));
  q.truth_to_wall = summary(std::move(theirs));
}

}  // namespace

OccupancyGrid resampled(const OccupancyGrid& map, const GridGeometry& geometry, const Pose2& T_target_map) {
  OccupancyGrid result(geometry);
  const Pose2 T_map_target = inverse(T_target_map);
  const int n = std::max(1, static_cast<int>(std::ceil(geometry.resolution / map.geometry().resolution - 1e-6)));
  for (std::size_t i = 0; i < result.size(); ++i) {
    const Point centre = geometry.center(geometry.cell_at(i));
    for (int k = 0; k < n * n && result[i] != CellState::kOccupied; ++k) {
      const double dx = ((k % n) + 0.5) / n - 0.5, dy = ((k / n) + 0.5) / n - 0.5;
      const Point p = T_map_target * Point{centre.x + dx * geometry.resolution, centre.y + dy * geometry.resolution};
      const Cell c = map.geometry().cell_of(p);
      if (map.contains(c)) result[i] = std::max(result[i], map[c]);
    }
  }
  return result;
}

MapQuality map_quality(const OccupancyGrid& map, const OccupancyGrid& truth, const Pose2& T_truth_map,
                       double tolerance_m) {
  if (map.geometry() != truth.geometry() || T_truth_map != Pose2{})
    return map_quality(resampled(map, truth.geometry(), T_truth_map), truth, {}, tolerance_m);
  std::array<std::array<std::size_t, 3>, 3> n{};  // [in the map][in truth]
  for (std::size_t i = 0; i < map.size(); ++i)
    if (is_judged(truth, truth.geometry().cell_at(i)))
      ++n[static_cast<std::size_t>(map[i])][static_cast<std::size_t>(truth[i])];
  constexpr std::size_t kU = 0, kF = 1, kO = 2;
  const std::size_t right = n[kO][kO] + n[kF][kF], known = right + n[kO][kF] + n[kF][kO];
  MapQuality q{.iou_occupied = ratio(n[kO][kO], n[kO][kO] + n[kO][kF] + n[kF][kO] + n[kU][kO]),
               .iou_free = ratio(n[kF][kF], n[kF][kF] + n[kF][kO] + n[kO][kF] + n[kU][kF]),
               .accuracy = ratio(right, known),
               .precision = ratio(n[kO][kO], n[kO][kO] + n[kO][kF]),
               .recall = ratio(n[kO][kO], n[kO][kO] + n[kF][kO] + n[kU][kO]),
               .completeness = ratio(known, known + n[kU][kF] + n[kU][kO]),
               .tolerance_m = std::max(tolerance_m, truth.geometry().resolution)};
  measure_distances(map, truth, q);
  return q;
}

Grid<MapError> map_errors(const OccupancyGrid& map, const OccupancyGrid& truth, const Pose2& T_truth_map) {
  const GridGeometry& g = map.geometry();
  const bool same = g == truth.geometry() && T_truth_map == Pose2{};
  Grid<MapError> errors(g);
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Cell c = same ? g.cell_at(i) : truth.geometry().cell_of(T_truth_map * g.center(g.cell_at(i)));
    if (!is_judged(truth, c) || map[i] == truth[c]) continue;
    errors[i] = map[i] == CellState::kUnknown    ? MapError::kUnseen
                : map[i] == CellState::kOccupied ? MapError::kFalseWall
                                                 : MapError::kMissedWall;
  }
  return errors;
}

}  // namespace outrider::report
