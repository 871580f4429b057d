#pragma once
// Internal to known_map_plan.cpp: legs between way-points, with what is newly in view on them.

#include <cstdint>
#include <map>
#include <memory>
#include <unordered_map>
#include <vector>

#include "decision/distance_field.hpp"
#include "sim/visibility.hpp"
#include "world/grid.hpp"

namespace outrider::explorer {

/// A step into a neighbouring cell.
struct ViewStep {
  double metres = 0.0;
  const std::vector<std::uint32_t>* seen = nullptr;  ///< cells in view from there but not from the cell before
};
using Leg = std::vector<ViewStep>;

/// Legs for robots of one range and one radius; made when asked for, kept for ever.
class Views {
 public:
  Views(const OccupancyGrid& truth, const Grid<std::uint8_t>& passable, double range);

  /// The shortest safe way; empty when there is none, or `from` is `to`.
  const Leg& leg(Cell from, Cell to);
  /// Length of that way [m]; infinite when there is none.
  double metres(Cell from, Cell to) { return field_to(to).metres(from); }
  /// Cells in view from `from`.
  const std::vector<std::uint32_t>& view(Cell from) { return newly(from, from); }

 private:
  const decision::DistanceField& field_to(Cell to);
  const std::vector<std::uint32_t>& newly(Cell at, Cell before);
  std::uint64_t key(Cell a, Cell b) const;

  const Grid<std::uint8_t>& passable_;
  GridGeometry geometry_;
  sim::CellSensor sensor_;
  std::vector<std::uint8_t> marks_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> newly_;  // looked up, never iterated
  std::unordered_map<std::uint64_t, Leg> legs_;
  std::unordered_map<std::uint64_t, std::unique_ptr<decision::DistanceField>> fields_;
};

}  // namespace outrider::explorer
