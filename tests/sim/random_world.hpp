#pragma once

#include <cstdint>
#include <random>

#include "world/grid.hpp"

namespace outrider::sim {

inline double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A map in which each cell is occupied with probability `share`.
inline OccupancyGrid random_map(int width, int height, double resolution, double share, std::mt19937_64& random) {
  OccupancyGrid map(GridGeometry{resolution, {-1.5, 2.25}, width, height}, CellState::kFree);
  for (CellState& cell : map.data())
    if (uniform(random, 0.0, 1.0) < share) cell = CellState::kOccupied;
  return map;
}

/// Distance from `p` to the nearest solid square, by looking at all of them; 0 inside one or outside the map.
inline double clearance_by_search(const OccupancyGrid& map, Point p) {
  const GridGeometry& g = map.geometry();
  if (!g.contains(g.cell_of(p))) return 0.0;
  double best = std::min({p.x - g.origin.x, p.y - g.origin.y, g.origin.x + g.width * g.resolution - p.x,
                          g.origin.y + g.height * g.resolution - p.y});
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] == CellState::kFree) continue;
    const Point c = g.center(g.cell_at(i));
    const double dx = std::max(0.0, std::abs(p.x - c.x) - 0.5 * g.resolution);
    const double dy = std::max(0.0, std::abs(p.y - c.y) - 0.5 * g.resolution);
    best = std::min(best, std::hypot(dx, dy));
  }
  return best;
}

}  // namespace outrider::sim
