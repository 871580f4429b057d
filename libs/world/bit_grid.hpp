#pragma once

#include <algorithm>
#include <vector>

#include "world/grid.hpp"

namespace outrider {

/// A set of cells: one bit a cell of the grid. Nothing is in it at first.
class BitGrid {
 public:
  BitGrid() = default;
  explicit BitGrid(const GridGeometry& geometry) : geometry_(geometry), bits_(geometry.size(), false) {}

  const GridGeometry& geometry() const { return geometry_; }
  std::size_t size() const { return bits_.size(); }  ///< of the grid [cells]
  bool operator[](std::size_t index) const { return bits_[index]; }
  void insert(std::size_t index) { bits_[index] = true; }
  std::size_t count() const { return static_cast<std::size_t>(std::count(bits_.begin(), bits_.end(), true)); }

 private:
  GridGeometry geometry_;
  std::vector<bool> bits_;
};

}  // namespace outrider
