#pragma once
// Whether a map agrees with the scans it was made from: what can be said of its quality without a true map.

#include <vector>

#include "slam_glue/surface_points.hpp"
#include "world/grid.hpp"

namespace outrider::slam_glue {

/// Walls drawn twice, beams that pass through walls: signs of wrong poses. Shares are 0..1.
struct SelfConsistency {
  std::size_t scans = 0;          ///< looked at
  double end_points_agree = 0.0;  ///< of the beams' end points, the share on or beside a wall of the map
  double seen_through = 0.0;      ///< of the beams, the share that passes through a wall of the map before its end
  double doubled_walls = 0.0;     ///< of the wall cells, the share with a second wall facing the same way close before it
};

/// Collects a sample of the scans along the final trajectory; memory grows with the sample.
class ConsistencyCheck {
 public:
  explicit ConsistencyCheck(double max_range_m) : max_range_m_(max_range_m) {}
  /// O(beams).
  void add(const LaserScan& scan, const Pose2& T_map_robot);
  /// Compares with the finished map. O(cells on the beams + cells of the map).
  SelfConsistency result(const OccupancyGrid& map) const;

 private:
  struct Beam {
    Point from;
    SurfacePoint end;
  };
  double max_range_m_;
  std::size_t scans_ = 0;
  std::vector<Beam> beams_;
};

}  // namespace outrider::slam_glue
