#include "world/ray.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

namespace outrider {
namespace {

/// A ray seen along the axis in which it is longer. It goes through the grid lane by lane (column by column, say), and
/// crosses one or two cells of each, because it is not steep. Which ones follows from its height where it leaves each
/// lane, and these heights are an arithmetic progression: no step waits for the result of the one before.
struct Lanes {
  int lane, lanes;                    ///< where the ray begins, and how many there are
  int row, rows;                      ///< the same across
  int step, row_step;                 ///< +1 or -1
  double t, per_lane;                 ///< of the next crossing of lanes and between two [m]
  double row_t, per_row;              ///< of rows
  std::ptrdiff_t stride, row_stride;  ///< index distance of neighbours along and across
};

Lanes lanes_of(const RayWalk& w, const GridGeometry& g, bool along_x) {
  if (along_x)
    return {w.cell.x, g.width, w.cell.y, g.height, w.step_x, w.step_y, w.t_x, w.per_x, w.t_y, w.per_y, 1, g.width};
  return {w.cell.y, g.height, w.cell.x, g.width, w.step_y, w.step_x, w.t_y, w.per_y, w.t_x, w.per_x, g.width, 1};
}

/// How many lanes, from the first on, the ray surely leaves within both the grid and `range`.
int whole_lanes(const Lanes& ray, double range) {
  const int ahead = ray.step > 0 ? ray.lanes - 1 - ray.lane : ray.lane;
  const int rows_ahead = ray.row_step > 0 ? ray.rows - 1 - ray.row : ray.row;
  const double leaves = std::isinf(ray.per_row) ? range : std::min(range, ray.row_t + rows_ahead * ray.per_row);
  const double whole = (leaves - ray.t) / ray.per_lane;  // one fewer than fit: rounding cannot matter
  return whole > 0.0 ? static_cast<int>(std::min<double>(whole, ahead)) : 0;
}

constexpr int kFraction = 44;  // bits after the point: rows up to 2^18 fit, errors stay below 1e-9 of a cell

/// The height at which the ray leaves the first lane, in rows from the lower edge of its first row, and what it grows
/// by with each lane.
struct Heights {
  std::int64_t first, each;
};
Heights heights_of(const Lanes& ray, bool along_x) {
  constexpr std::int64_t kOne = std::int64_t{1} << kFraction;
  if (std::isinf(ray.per_row)) return {kOne / 2, 0};
  const bool up = ray.row_step > 0;
  // At row_t the ray is at the first row's far edge.
  const double first = (up ? 1.0 : 0.0) + ray.row_step * (ray.t - ray.row_t) / ray.per_row;
  const double each = ray.row_step * ray.per_lane / ray.per_row;
  // A hair more or less, so that a ray through a corner takes the neighbour in x first, as RayWalk does. It must not
  // lead back into the row before, nor across two.
  const std::int64_t hair = 64 * (along_x ? -ray.row_step : ray.row_step);
  const std::int64_t height = static_cast<std::int64_t>(first * kOne) + hair;
  return {std::clamp(height, up ? 0 : -kOne, up ? 2 * kOne - 1 : kOne - 1), static_cast<std::int64_t>(each * kOne)};
}

/// Moves the walk, still at its beginning, past lanes without occupied cells.
void skip_free(RayWalk& walk, const OccupancyGrid& map, double range) {
  const bool along_x = walk.per_x <= walk.per_y;
  const Lanes ray = lanes_of(walk, map.geometry(), along_x);
  const int whole = whole_lanes(ray, range);
  const Heights heights = heights_of(ray, along_x);
  const std::int64_t last_row = (heights.first + whole * heights.each) >> kFraction;
  if (ray.row + last_row < 0 || ray.row + last_row >= ray.rows) return;  // within rounding of the border
  const CellState* lane = map.data().data() + map.geometry().index(walk.cell);
  const std::ptrdiff_t stride = ray.step * ray.stride;
  std::int64_t height = heights.first, row = 0;  // from the first row
  int skipped = 0;
  for (; skipped < whole; ++skipped) {
    const std::int64_t next_row = height >> kFraction;
    if (lane[row * ray.row_stride] == CellState::kOccupied || lane[next_row * ray.row_stride] == CellState::kOccupied)
      break;
    row = next_row;
    height += heights.each;
    lane += stride;
  }
  if (skipped == 0) return;
  walk.t = ray.t + (skipped - 1) * ray.per_lane;
  (along_x ? walk.t_x : walk.t_y) = ray.t + skipped * ray.per_lane;
  (along_x ? walk.cell.x : walk.cell.y) += ray.step * skipped;
  (along_x ? walk.cell.y : walk.cell.x) += static_cast<int>(row);
  // Not before the ray entered the lane: along an edge it may have crossed by less than the hair.
  const double next_row_t = row == 0 ? ray.row_t : ray.row_t + static_cast<double>(std::abs(row)) * ray.per_row;
  (along_x ? walk.t_y : walk.t_x) = std::max(next_row_t, walk.t);
}

/// Distance to the first occupied cell, or `none`.
double cast(const OccupancyGrid& map, Point from, double angle, double range, double none) {
  const GridGeometry& g = map.geometry();
  RayWalk walk(g, from, std::cos(angle), std::sin(angle));
  if (!g.contains(walk.cell)) return none;
  skip_free(walk, map, range);
  for (; walk.t <= range && g.contains(walk.cell); walk.advance())
    if (map[walk.cell] == CellState::kOccupied) return walk.t;
  return none;
}

}  // namespace

std::optional<double> cast_ray(const OccupancyGrid& map, Point from, double angle, double range) {
  const double hit = cast(map, from, angle, range, -1.0);
  return hit < 0.0 ? std::nullopt : std::optional(hit);
}

void cast_scan(const OccupancyGrid& map, Point from, double angle_min, double angle_increment, std::span<float> ranges,
               double range_max) {
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double angle = angle_min + static_cast<double>(i) * angle_increment;
    ranges[i] = static_cast<float>(cast(map, from, angle, range_max, range_max));
  }
}

bool line_of_sight(const OccupancyGrid& map, Cell a, Cell b) {
  const std::int64_t dx = std::abs(b.x - a.x), dy = std::abs(b.y - a.y);
  const int step_x = b.x > a.x ? 1 : -1, step_y = b.y > a.y ? 1 : -1;
  const auto occupied = [&](int x, int y) { return map[Cell{x, y}] == CellState::kOccupied; };
  // Which edge comes next: negative the one in x, positive the one in y, zero both at once. The i-th edge in x is
  // crossed at (2 i + 1) / (2 dx) of the way.
  std::int64_t next = dy - dx;
  for (Cell c = a; c != b;) {
    if (occupied(c.x, c.y)) return false;
    const bool in_x = next <= 0, in_y = next >= 0;
    if (in_x && in_y && occupied(c.x + step_x, c.y) && occupied(c.x, c.y + step_y)) return false;
    c = {c.x + (in_x ? step_x : 0), c.y + (in_y ? step_y : 0)};
    next += (in_x ? 2 * dy : 0) - (in_y ? 2 * dx : 0);
  }
  return !occupied(b.x, b.y);
}

}  // namespace outrider
