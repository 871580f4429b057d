#pragma once
// Where the known ends, kept up to date from what changes.

#include <cstdint>
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

  bool is_frontier(Cell c) const { return cells_.contains(c) && frontier(cells_[c]); }
  bool is_frontier(std::size_t index) const { return frontier(cells_[index]); }
  std::size_t count() const { return count_; }  ///< frontier cells
  /// At least `least` frontier cells hang together (8 neighbours) with frontier cell `c`. O(least^2).
  bool has_company(Cell c, std::size_t least) const;

 private:
  // Low nibble: unknown neighbours; above it the state as of the last update.
  static constexpr std::uint8_t kUnknownNeighbours = 0x0F;
  static constexpr int kStateShift = 4;
  static bool frontier(std::uint8_t cell) {
    return cell >> kStateShift == static_cast<int>(CellState::kFree) && (cell & kUnknownNeighbours) != 0;
  }
  void store(std::size_t index, std::uint8_t cell);

  Grid<std::uint8_t> cells_;
  std::size_t count_ = 0;
  std::vector<std::uint32_t> flipped_;
};

}  // namespace outrider::decision
