#pragma once
// The cell sensor: which cells does a robot see from the centre of the cell it is in?
//
// The rule. Every cell within range (of cell centres) looks to the sensor by a fixed way of cells, one after the other
// along the longer axis, which stays as near as possible to the straight line. These ways form a tree: a cell's parent
// is the first cell of its way. A free cell is seen when all cells of its way are free and no diagonal step of the way
// squeezes between two occupied cells. An occupied cell is seen when one of the cells next to it (of 8) that are not
// farther from the sensor in either axis is seen and free: its face is in view.
// So walls never leak, not even diagonal ones, and the inner corners of rooms are seen.

#include <cstdint>
#include <span>
#include <vector>

#include "world/body.hpp"
#include "world/grid.hpp"

namespace outrider::sim {

/// The ways of all cells of a disc, as a tree in depth-first order: the centre first, parents before children.
class VisibilityTree {
 public:
  struct Node {
    Cell offset;     ///< from the centre
    int parent = 0;  ///< index of the next node on the way to the centre; the centre is its own
    int end = 0;     ///< index after the last node whose way leads through this one
  };

  /// All cells with |offset| <= range_cells, and no farther than `farthest` in either axis. O(cells * range).
  VisibilityTree(double range_cells, int farthest);

  std::span<const Node> nodes() const { return nodes_; }

 private:
  std::vector<Node> nodes_;
};

/// Cell sensor of one range on one map. Immutable; what a robot has seen already is kept by the caller.
class CellSensor {
 public:
  /// `range` [m]. Unknown cells of `truth` look occupied. Copies what it needs.
  CellSensor(const OccupancyGrid& truth, double range);

  /// Appends to `out` the cells seen from `from` (a free cell) that are not yet marked in `seen` (a vector of bool or of
  /// bytes, one a cell), and marks them. O(cells of the disc that are in view).
  template <class Seen>
  void sense(Cell from, Seen& seen, std::vector<SeenCell>& out) const;

 private:
  struct Node {
    std::int32_t padded = 0;   ///< offset in cells_
    std::int32_t offset = 0;   ///< offset in the map
    std::int32_t end = 0;      ///< where to go on when nothing is seen through this cell
    std::uint8_t squeeze = 0;  ///< the two neighbours that a diagonal step into this cell passes between
    std::uint8_t outward = 0;  ///< the neighbours, in range, whose faces this cell shows
  };

  int padded_width() const { return geometry_.width + 2 * margin_; }
  void pad(const OccupancyGrid& truth);
  Node compiled(const VisibilityTree::Node& from, Cell parent, double range_cells) const;

  GridGeometry geometry_;
  int margin_ = 0;                    ///< solid cells added on all sides, so that no look-up needs a bounds check
  std::vector<std::uint16_t> cells_;  ///< padded map: kSolid, and one bit for each occupied neighbour
  std::vector<Node> nodes_;
};

}  // namespace outrider::sim
