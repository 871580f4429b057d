#pragma once
// Scans with known poses -> MRPT's occupancy grid, by exact ray traversal.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <vector>

#include "world/grid.hpp"
#include "world/scan.hpp"

namespace outrider::slam_glue {

struct MapperOptions {
  double max_range_m = std::numeric_limits<double>::infinity();  ///< insert at most this far [m]
  /// How far a beam without echo clears [m]; never beyond the scan's range_max nor max_range_m.
  double no_echo_range_m = std::numeric_limits<double>::infinity();
  int hit = 48;   ///< weight of a hit, in MRPT's cell units (log-odds * 16), 1..127
  int miss = 12;  ///< weight of a ray that passes; a hit outweighs several grazing rays
};

/// The map of record of one robot: a COccupancyGridMap2D and its three-state view, kept in step. A cell changes at most
/// once a scan; a hit wins over the misses of the same scan. One miss makes an unknown cell free, one hit occupied.
/// Movable, not copyable; not thread-safe.
class GridMapper {
 public:
  explicit GridMapper(const GridGeometry& geometry, const MapperOptions& options = {});
  ~GridMapper();
  GridMapper(GridMapper&&) noexcept;
  GridMapper& operator=(GridMapper&&) noexcept;

  /// Inserts one scan taken at `T_map_robot` and appends the indices of the cells whose three-state value changed
  /// (each at most once a call). Cells outside the geometry are ignored. O(cells on the rays).
  void insert(const LaserScan& scan, const Pose2& T_map_robot, std::vector<std::uint32_t>& changed);

  const OccupancyGrid& states() const;

  /// Writes MRPT's grid (see save_gridmap).
  void save(const std::filesystem::path& gridmap) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace outrider::slam_glue
