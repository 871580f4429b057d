#pragma once
// The skeleton of free space as a graph: places where ways meet or end, and the ways between them.

#include <cstdint>
#include <vector>

#include "world/grid.hpp"

namespace outrider::decision {

struct SkeletonNode {
  Cell cell;
  double clearance = 0.0;   ///< [m]
  std::vector<int> edges;   ///< that begin or end here; a loop is listed twice
};

struct SkeletonEdge {
  int a = 0, b = 0;          ///< nodes
  std::vector<Cell> cells;   ///< from a's cell to b's, both included, 8-neighbours
  double length = 0.0;       ///< [m]
};

struct Skeleton {
  std::vector<SkeletonNode> nodes;
  std::vector<SkeletonEdge> edges;
  Grid<float> clearance;  ///< distance from a cell's centre to the nearest cell that is not free, to its edge [m]
};

/// How far every free cell of `map` is from the nearest cell that is not known free, and from the edge of the map [m].
Grid<float> clearances(const OccupancyGrid& map);

/// Thins `mask` (cells where a robot may be) to lines in the order of clearance, so that they run in the middle of ways
/// (distance-ordered homotopic thinning: no way appears, none disappears). 1 = on the skeleton. O(n log n).
Grid<std::uint8_t> thinned(const Grid<std::uint8_t>& mask, const Grid<float>& clearance);

/// The skeleton of the largest connected part of `mask` as a graph, cleaned: spurs that only point into corners are
/// cut, meeting places within each other's free disc become one, and small loops vanish.
Skeleton skeleton_of(const OccupancyGrid& map, const Grid<std::uint8_t>& mask);

}  // namespace outrider::decision
