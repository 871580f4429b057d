#pragma once
// Where the known ends, kept up to date from what changes.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "world/grid.hpp"

namespace outrider::decision {

/// The frontier cells of a map that is being discovered, as of decision::is_frontier, in time proportional to the
/// changes. One byte a cell.
class FrontierMap {
 public:
  /// Everything is unknown.
  explicit FrontierMap(const GridGeometry& geometry);

  /// Follows `map` after the cells `changed` (indices, duplicates allowed) changed. Returns the cells that became
  /// frontier or ceased to be, maybe more than once; valid until the next call.
  std::span<const std::uint32_t> update(const OccupancyGrid& map, std::span<const std::uint32_t> changed);

  bool is_frontier(Cell c) const { return cells_.contains(c) && is_frontier(cells_.geometry().index(c)); }
  bool is_frontier(std::size_t index) const { return cells_[index] >= kFrontier; }
  std::size_t count() const { return count_; }  ///< frontier cells
  /// Calls visit(cell) for the frontier cells of the rectangle [low, high), row by row. Far faster than to ask for each.
  template <class Visit>
  void for_frontier(Cell low, Cell high, Visit&& visit) const {
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; x += 8)
        for (std::uint64_t flags = eight(x, y, std::min(8, high.x - x)); flags != 0; flags &= flags - 1)
          visit(Cell{x + std::countr_zero(flags) / 8, y});
  }
  /// At least `least` frontier cells hang together (8 neighbours) with frontier cell `c`. O(least^2).
  bool has_company(Cell c, std::size_t least) const;

 private:
  // A cell: the number of unknown neighbours, the state as of the last update, and whether these two make it a frontier.
  static constexpr std::uint8_t kUnknownNeighbours = 0x0F, kState = 0x30, kFrontier = 0x80;
  static constexpr int kStateShift = 4;
  /// The frontier flags of `n` <= 8 cells from (x, y) on, one a byte.
  std::uint64_t eight(int x, int y, int n) const {
    std::uint64_t cells = 0;
    std::memcpy(&cells, cells_.data().data() + cells_.geometry().index({x, y}), static_cast<std::size_t>(n));
    return cells & 0x8080808080808080U;
  }
  void store(std::size_t index, std::uint8_t cell);

  Grid<std::uint8_t> cells_;
  std::size_t count_ = 0;
  std::vector<std::uint32_t> flipped_;
};

}  // namespace outrider::decision
