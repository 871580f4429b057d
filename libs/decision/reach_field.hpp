#pragma once
// How far it is from one cell to those around it, searched outwards only as far as somebody asks.

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "world/grid.hpp"

namespace outrider::decision {

/// Lengths of shortest octile paths from a cell, the same as DistanceField's, for a searcher that usually needs its
/// neighbourhood only: nothing here takes time proportional to the map but the constructor. Keeps the mask as levels,
/// updated from its changes. Every search uses levels below those of all earlier ones, so that nothing need be cleared.
class ReachField {
 public:
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  /// Nothing is passable yet.
  explicit ReachField(const GridGeometry& geometry);

  /// Follows `mask` after at most the cells `changed` (indices, duplicates allowed) changed. Ends the search: begin()
  /// comes next.
  void update(const Grid<std::uint8_t>& mask, std::span<const std::uint32_t> changed);
  /// Starts a new search. The source counts as passable whatever the mask says; it must be inside the grid.
  void begin(Cell source);
  /// Goes on until all cells within `max_m` [m] of the source are reached. O(cells reached).
  void extend(double max_m);
  /// Nothing is left to be reached.
  bool exhausted() const { return empty_ == 8; }

  /// True when extend() has come as far as `c`.
  bool reached(Cell c) const { return geometry_.contains(c) && level(c) - base_ <= settled_; }
  /// Length of the shortest path from the source [m]; infinity when not reached.
  double metres(Cell c) const {
    return reached(c) ? static_cast<double>(level(c) - base_) * geometry_.resolution / 5.0 : kNoLimit;
  }
  /// The shortest path from `from` to the source, both included, as of DistanceField::path; empty when not reached.
  std::vector<Cell> path(Cell from) const;

 private:
  std::uint32_t level(Cell c) const { return levels_[padded_index(c)]; }
  std::size_t padded_index(Cell c) const {
    return static_cast<std::size_t>(c.y + 1) * static_cast<std::size_t>(geometry_.width + 2) +
           static_cast<std::size_t>(c.x + 1);
  }

  GridGeometry geometry_;
  std::vector<std::uint32_t> levels_;  // padded; 0 blocked, base_ + distance, or more than any of this search
  std::size_t open_ = 0;               // passable cells
  std::uint32_t base_;                 // level of the source
  std::uint32_t settled_ = 0;          // distances up to here are final
  std::uint32_t next_ = 0;             // distance of the bucket to be expanded next
  std::size_t empty_ = 8;              // buckets in a row that were empty
  std::size_t borrowed_;               // padded index of a source that the mask forbids, or 0
  std::array<std::vector<std::uint32_t>, 8> buckets_;
  std::array<std::size_t, 8> sizes_{};
};

}  // namespace outrider::decision
