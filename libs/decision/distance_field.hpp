#pragma once
// How far it is from everywhere to the nearest of some sources.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "world/grid.hpp"

namespace outrider::decision {

/// Which steps a path may take.
enum class Steps {
  kOctile,      ///< to the 8 neighbours, where step_allowed; a diagonal counts as 7/5 of an edge (1 % below sqrt 2)
  kOrthogonal,  ///< to the 4 neighbours
};

/// Lengths of shortest paths over a passable mask. Dial's bucket queue (Dial 1969) on integer weights, the obstacle
/// test fused into the distances: O(cells). Distances take 16 bits, or 32 when a path turns out to be too long.
class DistanceField {
 public:
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  /// Replaces the field; memory is reused. Cells farther than `max_m` [m] stay unreached. Sources count as passable
  /// whatever the mask says; sources outside the grid are ignored.
  void compute(const Grid<std::uint8_t>& mask, std::span<const Cell> sources, double max_m = kNoLimit,
               Steps steps = Steps::kOctile);

  bool reached(Cell c) const;
  /// Length of the shortest path from `c` to the nearest source [m]; infinity when not reached.
  double metres(Cell c) const;
  /// The shortest path from `from` down to the nearest source, both included; empty when not reached. Among equally
  /// short ways it goes on straight, then prefers the earlier direction of a fixed order.
  std::vector<Cell> path(Cell from) const;
  const GridGeometry& geometry() const { return geometry_; }

 private:
  template <class D>
  bool fill(std::vector<D>& levels, const Grid<std::uint8_t>& mask, std::span<const Cell> sources, std::uint32_t limit);
  std::uint32_t level(Cell c) const;
  std::size_t padded_index(Cell c) const {
    return static_cast<std::size_t>(c.y + 1) * static_cast<std::size_t>(geometry_.width + 2) +
           static_cast<std::size_t>(c.x + 1);
  }

  GridGeometry geometry_;
  Steps steps_ = Steps::kOctile;
  bool narrow_ = true;                   // which of the two holds the field
  std::vector<std::uint16_t> levels16_;  // padded by one blocked cell all around
  std::vector<std::uint32_t> levels32_;
  std::array<std::vector<std::uint32_t>, 8> buckets_;  // cells by distance, a ring as in Dial 1969
};

}  // namespace outrider::decision
