#pragma once
// Where a disc-shaped robot fits, and which steps between cells are safe.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "world/grid.hpp"

namespace outrider::decision {

/// Half widths of the rows of the cells that an occupied cell forbids to the centre of a disc robot: row dy forbids
/// |dx| < half_widths[|dy|]; one entry a row, dy = 0 first. A cell is forbidden when the distance from its centre to
/// the occupied cell's square is below the radius; touching is allowed.
std::vector<int> forbidden_half_widths(double radius_m, double resolution);

/// Where the centre of a disc robot may be: cells known free whose distance from the cell centre to every occupied
/// cell's square, and to the edge of the map, is at least the radius. Unknown cells are not passable themselves but do
/// not inflate. Three bytes a cell.
class Passability {
 public:
  /// Everything is unknown. Throws InputError when the radius [m] is negative, not finite or above 64 cells.
  Passability(const GridGeometry& geometry, double radius_m);

  /// Follows `map` after the cells `changed` (indices, duplicates allowed) changed. O(changed x mask size). Returns the
  /// cells whose passability changed, maybe more than once; valid until the next call.
  std::span<const std::uint32_t> update(const OccupancyGrid& map, std::span<const std::uint32_t> changed);

  bool passable(Cell c) const { return mask_.contains(c) && mask_[c] != 0; }
  const Grid<std::uint8_t>& mask() const { return mask_; }  ///< 1 = passable
  double radius() const { return radius_; }                 ///< [m]

 private:
  void add_obstacle(Cell c);
  void remove_obstacle(Cell c);
  template <class RowOperation>
  void for_rows_around(Cell c, RowOperation&& operation);
  void set(std::size_t index, bool passable);

  static constexpr unsigned kStateShift = 14;
  CellState known(std::size_t index) const { return static_cast<CellState>(cells_[index] >> kStateShift); }
  unsigned obstacles(std::size_t index) const { return cells_[index] & ((1U << kStateShift) - 1U); }

  double radius_;
  std::vector<int> half_widths_;
  Grid<std::uint16_t> cells_;      // how many occupied cells forbid a cell, and above that its state at the last update
  Grid<std::uint8_t> mask_;
  std::vector<std::uint32_t> changed_;  // what the last update changed in the mask
};

/// The mask of a whole map at once, for true maps: O(cells + runs of occupied cells x mask area).
Grid<std::uint8_t> passable_mask(const OccupancyGrid& map, double radius_m);

/// May the robot move in a straight line between the centres of the 8-neighbours `from` and `to`? Both must be
/// passable, and for a diagonal both orthogonal neighbours too. Then the moving disc touches no occupied square:
///   The squared distance from (x, y) to a square is f(x) + g(y), where f falls up to the square's near edge, is zero
///   across the square, and rises from its far edge. These edges lie midway between columns of cell centres, one cell
///   apart, so f is monotonic over any single step, and so is g: each is smallest at an end. Along an orthogonal step
///   only one of them changes, so the nearest point is an end of the step. Along a diagonal step no point is nearer
///   than min f + min g, which is the value at one of the four corners of the step's square, all of them passable.
bool step_allowed(const Grid<std::uint8_t>& mask, Cell from, Cell to);

/// The passable cell nearest to `c` (which may be passable itself) by distance between centres, at most `max_cells`
/// away, ties by index. Does not ask whether there is a way. O(d^2) for an answer at d cells.
std::optional<Cell> nearest_passable(const Grid<std::uint8_t>& mask, Cell c, int max_cells);

}  // namespace outrider::decision
