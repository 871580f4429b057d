#pragma once
// Exact grid traversal (Amanatides and Woo 1987): every cell that a ray crosses, in order, none skipped.

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>

#include "world/grid.hpp"

namespace outrider {

/// The walk of a ray from cell to cell. Distances are along the ray from its beginning [m].
struct RayWalk {
  Cell cell;            ///< where the walk is; may lie outside the grid
  double t = 0.0;       ///< at which the ray entered `cell`
  double t_x, t_y;      ///< at which it will cross into the next column and the next row; infinity for never
  double per_x, per_y;  ///< between two such crossings
  int step_x, step_y;   ///< +1 or -1

  /// A ray from `from` towards the unit vector (dx, dy).
  RayWalk(const GridGeometry& g, Point from, double dx, double dy)
      : cell(g.cell_of(from)), step_x(dx > 0 ? 1 : -1), step_y(dy > 0 ? 1 : -1) {
    constexpr double kNever = std::numeric_limits<double>::infinity();
    const double edge_x = g.origin.x + (cell.x + (dx > 0)) * g.resolution;
    const double edge_y = g.origin.y + (cell.y + (dy > 0)) * g.resolution;
    t_x = dx == 0.0 ? kNever : std::max(0.0, (edge_x - from.x) / dx);
    t_y = dy == 0.0 ? kNever : std::max(0.0, (edge_y - from.y) / dy);
    per_x = dx == 0.0 ? kNever : g.resolution / std::abs(dx);
    per_y = dy == 0.0 ? kNever : g.resolution / std::abs(dy);
  }

  /// Into the next cell. Through a corner: into the neighbour in x first.
  void advance() {
    if (t_x <= t_y) {
      t = t_x;
      t_x += per_x;
      cell.x += step_x;
    } else {
      t = t_y;
      t_y += per_y;
      cell.y += step_y;
    }
  }
};

/// Calls visit(cell, entry_distance_m) for each cell on the ray from `from` towards (dx, dy) (unit vector),
/// beginning with the cell of `from`, until visit returns false, the ray leaves the grid, or the entry distance
/// exceeds `range`. A ray through a corner visits the x-neighbour first. A ray from outside the grid visits nothing.
/// O(cells visited).
template <class Visit>
void walk_ray(const GridGeometry& g, Point from, double dx, double dy, double range, Visit&& visit) {
  for (RayWalk walk(g, from, dx, dy); walk.t <= range && g.contains(walk.cell); walk.advance())
    if (!visit(walk.cell, walk.t)) return;
}

/// Distance from `from` along `angle` [rad] to the first occupied cell [m], if one lies within `range`. 0 inside an
/// occupied cell; never an echo from outside the grid. O(cells on the way), about 1 ns each.
std::optional<double> cast_ray(const OccupancyGrid& map, Point from, double angle, double range);

/// A whole scan: ranges[i] = cast_ray(map, from, angle_min + i * angle_increment, range_max), `range_max` [m] where
/// there is no echo. Angles [rad] in the map frame.
void cast_scan(const OccupancyGrid& map, Point from, double angle_min, double angle_increment, std::span<float> ranges,
               double range_max);

/// True when no occupied cell lies on the segment between the centres of `a` and `b` (both included, both in the map).
/// A corner that the segment passes through exactly blocks it when both cells beside it are occupied: diagonal walls
/// are closed. Whole numbers only: exact, and the same from either end. O(cells on the way).
bool line_of_sight(const OccupancyGrid& map, Cell a, Cell b);

}  // namespace outrider
