#pragma once

#include <cstdint>

#include "sim/sweep.hpp"
#include "world/grid.hpp"

namespace outrider::sim {

/// The walls of a true map as discs of one radius meet them. Occupied and unknown cells are solid squares; outside the
/// grid is solid. Keeps a pointer to the map, which must outlive it and not change.
class Walls {
 public:
  /// O(cells * radius / resolution).
  Walls(const OccupancyGrid& truth, double radius);

  double radius() const { return radius_; }
  /// A disc may stand at the centre of `c` (false outside the grid).
  bool passable(Cell c) const { return room_.contains(c) && room_[c] != Room::kNone; }
  /// A disc may stand at `p`: no solid square nearer than radius - kTouchTolerance.
  bool fits(Point p) const;
  /// How far a disc can be driven from `from` straight towards `to` [m]; at least the distance of the two when nothing
  /// is in the way. O(1) between centres of neighbouring passable cells (diagonally: when both cells beside are
  /// passable too), O(cells on the way) in the open, O(cells within radius of the way) beside walls.
  double free_length(Point from, Point to) const;

 private:
  enum class Room : std::uint8_t { kNone, kCenter, kWhole };  ///< a disc fits: not at all, at the centre, anywhere

  bool solid(Cell c) const { return !truth_->contains(c) || (*truth_)[c] != CellState::kFree; }
  Box square(Cell c) const;
  bool is_neighbour_step(Point from, Point to) const;
  bool all_open(const Sweep& way, double length) const;
  double first_contact(const Sweep& way, double length) const;

  const OccupancyGrid* truth_;
  double radius_;
  Grid<Room> room_;
};

}  // namespace outrider::sim
