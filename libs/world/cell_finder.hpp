#pragma once

#include "world/grid.hpp"

namespace outrider {

/// The cells of many indices, most of which lie in the row of the one before: that spares a division.
class CellFinder {
 public:
  explicit CellFinder(const GridGeometry& geometry) : width_(static_cast<std::size_t>(geometry.width)) {}

  Cell operator()(std::size_t index) {
    if (index - row_begin_ >= width_) {
      y_ = index / width_;
      row_begin_ = y_ * width_;
    }
    return {static_cast<int>(index - row_begin_), static_cast<int>(y_)};
  }

 private:
  std::size_t width_, row_begin_ = 0, y_ = 0;
};

}  // namespace outrider
