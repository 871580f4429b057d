#pragma once
// Grid geometry as a value type, and dense grids on it. Row 0 is at the bottom (MRPT's convention).

#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "world/geometry.hpp"

namespace outrider {

struct Cell {
  int x = 0;  ///< column, grows to the right
  int y = 0;  ///< row, grows upwards
  friend bool operator==(const Cell&, const Cell&) = default;
};

/// Where the cells of a grid lie in the map frame. Nobody else writes `y * width + x`.
struct GridGeometry {
  double resolution = 1.0;  ///< edge of a cell [m]
  Point origin;             ///< lower-left corner of cell (0, 0) [m]
  int width = 0;            ///< [cells]
  int height = 0;           ///< [cells]

  std::size_t size() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
  bool contains(Cell c) const { return c.x >= 0 && c.y >= 0 && c.x < width && c.y < height; }
  std::size_t index(Cell c) const {
    assert(contains(c));
    return static_cast<std::size_t>(c.y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(c.x);
  }
  Cell cell_at(std::size_t index) const {
    const auto w = static_cast<std::size_t>(width);
    return {static_cast<int>(index % w), static_cast<int>(index / w)};
  }
  /// The cell that holds `p`; may lie outside (floor, not truncation: MRPT's x2idx errs here).
  Cell cell_of(Point p) const {
    return {static_cast<int>(std::floor((p.x - origin.x) / resolution)),
            static_cast<int>(std::floor((p.y - origin.y) / resolution))};
  }
  Point center(Cell c) const {
    return {origin.x + (c.x + 0.5) * resolution, origin.y + (c.y + 0.5) * resolution};
  }
  double cell_area() const { return resolution * resolution; }  ///< [m^2]
  friend bool operator==(const GridGeometry&, const GridGeometry&) = default;
};

/// A dense grid of T. Value semantics; data is row-major, row 0 at the bottom.
template <class T>
class Grid {
 public:
  Grid() = default;
  explicit Grid(const GridGeometry& geometry, T value = T{}) : geometry_(geometry), data_(geometry.size(), value) {}

  const GridGeometry& geometry() const { return geometry_; }
  int width() const { return geometry_.width; }
  int height() const { return geometry_.height; }
  std::size_t size() const { return data_.size(); }
  bool contains(Cell c) const { return geometry_.contains(c); }

  T& operator[](Cell c) { return data_[geometry_.index(c)]; }
  const T& operator[](Cell c) const { return data_[geometry_.index(c)]; }
  T& operator[](std::size_t index) { return data_[index]; }
  const T& operator[](std::size_t index) const { return data_[index]; }

  std::vector<T>& data() { return data_; }
  const std::vector<T>& data() const { return data_; }
  friend bool operator==(const Grid&, const Grid&) = default;

 private:
  GridGeometry geometry_;
  std::vector<T> data_;
};

/// What is known of a cell. One byte; the order is part of the wire format.
enum class CellState : std::uint8_t { kUnknown = 0, kFree = 1, kOccupied = 2 };

using OccupancyGrid = Grid<CellState>;

}  // namespace outrider
