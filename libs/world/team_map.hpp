#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "world/messages.hpp"

namespace outrider {

/// Cuts a grid into square tiles, so that each fits into one frame on the air. Tiles are numbered row by row from the
/// lower left; those at the upper and right edges may be smaller.
struct Tiling {
  static constexpr int kEdge = 32;  ///< [cells]
  GridGeometry geometry;

  int across() const { return (geometry.width + kEdge - 1) / kEdge; }
  std::size_t count() const {
    return static_cast<std::size_t>(across()) * static_cast<std::size_t>((geometry.height + kEdge - 1) / kEdge);
  }
  std::size_t tile_at(Cell c) const {
    return static_cast<std::size_t>(c.y / kEdge) * static_cast<std::size_t>(across()) + static_cast<std::size_t>(c.x / kEdge);
  }
  /// Calls visit(index) for the cells of a tile, row by row from its lower left.
  template <class Visit>
  void for_cells(std::size_t tile, Visit&& visit) const {
    const int x0 = static_cast<int>(tile % static_cast<std::size_t>(across())) * kEdge;
    const int y0 = static_cast<int>(tile / static_cast<std::size_t>(across())) * kEdge;
    for (int y = y0; y < std::min(y0 + kEdge, geometry.height); ++y)
      for (int x = x0; x < std::min(x0 + kEdge, geometry.width); ++x) visit(geometry.index({x, y}));
  }
};

/// What one robot knows of the world: its own observations and what team-mates reported. A cell is a value, version and
/// state; the greater value wins. Merging is therefore commutative, associative and idempotent: robots that have heard
/// the same changes, in whatever order and however often, hold the same map. A byte a cell, and a second one in those
/// tiles that hold a version other than 1.
class TeamMap {
 public:
  static constexpr int kMostVersions = 63;  ///< the byte holds no more; then the greater state stands

  explicit TeamMap(const GridGeometry& geometry);

  const OccupancyGrid& states() const { return states_; }
  const Tiling& tiling() const { return tiling_; }

  /// The robot's own sensor says `state` (never kUnknown). True when that was news.
  bool observe(std::uint32_t index, CellState state);
  /// A team-mate's report. True when it changed what is known. Cells outside the map are ignored.
  bool merge(const CellRun& run);
  /// A whole tile, cell by cell as of tile(). True when it changed what is known; false for a wrong number of cells.
  bool merge_tile(std::size_t tile, std::span<const std::uint8_t> cells);

  std::vector<std::uint8_t> tile(std::size_t tile) const;
  const TileMark& mark(std::size_t tile) const { return marks_[tile]; }
  /// Equal for equal maps, and for different ones by accident only (1 in 2^64).
  std::uint64_t hash() const { return hash_; }

  /// Own observations that have not been handed out yet, each cell once, as they stand now.
  std::vector<CellRun> take_to_share();
  /// Cells whose state changed since the last call; may name a cell twice.
  std::vector<std::uint32_t> take_changed() { return std::exchange(changed_, {}); }

 private:
  bool raise(std::uint32_t index, Cell at, std::uint8_t value);
  std::uint8_t value(std::size_t index, std::size_t tile) const;
  void set_value(std::size_t index, std::size_t tile, std::uint8_t value);
  static std::size_t in_tile(Cell at);

  Tiling tiling_;
  OccupancyGrid states_;
  std::vector<std::vector<std::uint8_t>> values_;  // version * 4 + state of a tile's cells; none: version 1 where known
  std::vector<TileMark> marks_;
  std::uint64_t hash_ = 0;
  std::vector<std::uint32_t> to_share_, changed_;
};

}  // namespace outrider
