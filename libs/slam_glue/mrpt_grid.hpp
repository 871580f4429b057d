#pragma once
// Internal: MRPT's occupancy grid without MRPT's headers.

#include <cstdint>
#include <filesystem>
#include <memory>

#include "world/grid.hpp"

namespace outrider::slam_glue {

/// A COccupancyGridMap2D that lies exactly on `geometry` (MRPT alone would snap the origin to a multiple of the
/// resolution). Cells are int8 log-odds * 16: positive = free, 0 = unknown.
class MrptGrid {
 public:
  explicit MrptGrid(const GridGeometry& geometry);
  ~MrptGrid();
  MrptGrid(MrptGrid&&) noexcept;
  MrptGrid& operator=(MrptGrid&&) noexcept;

  std::int8_t* cells();  ///< row-major, row 0 at the bottom, `geometry.width` a row
  void save(const std::filesystem::path& gridmap) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Reads a .gridmap[.gz]; InputError when it is not a complete MRPT grid.
OccupancyGrid load_gridmap(const std::filesystem::path& file);

}  // namespace outrider::slam_glue
