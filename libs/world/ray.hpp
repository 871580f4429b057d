#pragma once
// Exact grid traversal (Amanatides and Woo 1987): every cell that a ray touches, in order, none skipped.

#include <cmath>
#include <limits>
#include <optional>

#include "world/grid.hpp"

namespace outrider {

/// Calls visit(cell, entry_distance_m) for each cell on the ray from `from` towards (dx, dy) (unit vector),
/// beginning with the cell of `from`, until visit returns false, the ray leaves the grid, or the entry distance
/// exceeds `range`. A ray through a corner visits the x-neighbour first. O(cells visited).
template <class Visit>
void walk_ray(const GridGeometry& g, Point from, double dx, double dy, double range, Visit&& visit) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  Cell c = g.cell_of(from);
  const int step_x = dx > 0 ? 1 : -1, step_y = dy > 0 ? 1 : -1;
  const double edge_x = g.origin.x + (c.x + (dx > 0)) * g.resolution;
  const double edge_y = g.origin.y + (c.y + (dy > 0)) * g.resolution;
  double t_x = dx == 0.0 ? kInf : (edge_x - from.x) / dx;
  double t_y = dy == 0.0 ? kInf : (edge_y - from.y) / dy;
  const double delta_x = dx == 0.0 ? kInf : g.resolution / std::abs(dx);
  const double delta_y = dy == 0.0 ? kInf : g.resolution / std::abs(dy);
  double t = 0.0;
  while (t <= range && g.contains(c)) {
    if (!visit(c, t)) return;
    if (t_x <= t_y) {
      t = t_x;
      t_x += delta_x;
      c.x += step_x;
    } else {
      t = t_y;
      t_y += delta_y;
      c.y += step_y;
    }
  }
}

/// Distance from `from` along `angle` [rad] to the first occupied cell [m], if one lies within `range`.
inline std::optional<double> cast_ray(const OccupancyGrid& map, Point from, double angle, double range) {
  std::optional<double> hit;
  walk_ray(map.geometry(), from, std::cos(angle), std::sin(angle), range, [&](Cell c, double t) {
    if (map[c] != CellState::kOccupied) return true;
    hit = t;
    return false;
  });
  return hit;
}

/// True when no occupied cell lies on the segment between the centres of `a` and `b` (both included).
inline bool line_of_sight(const OccupancyGrid& map, Cell a, Cell b) {
  const Point pa = map.geometry().center(a), pb = map.geometry().center(b);
  const double d = distance(pa, pb);
  if (d == 0.0) return map[a] != CellState::kOccupied;
  bool clear = true;
  walk_ray(map.geometry(), pa, (pb.x - pa.x) / d, (pb.y - pa.y) / d, d, [&](Cell c, double) {
    clear = map[c] != CellState::kOccupied;
    return clear && c != b;
  });
  return clear;
}

}  // namespace outrider
