#pragma once

#include <cstddef>
#include <vector>

#include "world/grid.hpp"

namespace outrider::decision {

/// How much a sensor of a given range would newly see from a cell: U_p1 of Dai 2014, "the size of the detectable
/// subset". Rays over the known map; unknown cells let the view through, occupied ones end it.
class Footprint {
 public:
  /// `range` [m] of the sensor. For maps of this geometry. Precomputes the rays.
  Footprint(double range, const GridGeometry& geometry);

  /// Unknown area within range and in line of sight of `from` [m^2]. O(rays x range / resolution).
  double unseen_area(const OccupancyGrid& map, Cell from) const;
  /// Area within range and in line of sight, known or not [m^2].
  double area(const OccupancyGrid& map, Cell from) const;

 private:
  template <class Counts>
  double sum(const OccupancyGrid& map, Cell from, Counts&& counts) const;

  struct Step {
    Cell offset;
    std::ptrdiff_t index;  // the same as a difference of indices
    double area;           // share of the disc that this cell of the ray stands for [m^2]
  };
  int reach_;  // no offset is longer in x or y [cells]
  std::vector<std::vector<Step>> rays_;
};

}  // namespace outrider::decision
