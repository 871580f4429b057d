#pragma once
// Exact geometry of a disc that moves in a straight line between the cells of a grid.

#include "world/grid.hpp"

namespace outrider::decision {

/// True when a disc of `radius` [m] can move from `a` to `b` without coming nearer than touching to the square of a cell
/// that is not known free, or to the edge of the map. O(cells of the bounding box).
bool sweep_clear(const OccupancyGrid& map, Point a, Point b, double radius);

}  // namespace outrider::decision
