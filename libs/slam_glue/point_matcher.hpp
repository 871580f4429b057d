#pragma once
// Internal: point-to-line scan matching (Censi 2008) by Gauss-Newton against a map of surface points.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slam_glue/surface_points.hpp"

namespace outrider::slam_glue {

/// A small map of surface points that answers "which point is near here" from a table.
class PointMap {
 public:
  static constexpr double kReach = 0.5;  ///< farthest answer [m]
  /// Points without a normal are left out. O(points * (kReach / cell)^2 + area / cell^2).
  explicit PointMap(std::vector<SurfacePoint> points);
  /// A map point near `p` (the nearest to the centre of p's cell), null when none is within about kReach.
  const SurfacePoint* near(Point p) const;
  bool empty() const { return points_.empty(); }

 private:
  std::vector<SurfacePoint> points_;
  Point origin_;
  int width_ = 0, height_ = 0;
  std::vector<std::int32_t> nearest_;  ///< index into points_, -1 = none
};

/// What is believed of the pose beforehand.
struct PosePrior {
  Pose2 mean;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of (x, y, theta) [1/m^2, 1/m rad, 1/rad^2]
};

struct PointMatch {
  Pose2 T_map_robot;
  Pose2 T_scan_only;  ///< where the surfaces alone would have it, without the prior
  /// Of (x, y, theta) in the map's frame, from the scan alone; nothing along directions that the surfaces leave open.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double share = 0.0;   ///< of the scan's points that lie on a surface of the map, 0..1
  double rms_m = 0.0;   ///< of their distances to it
  bool bound = false;   ///< the surfaces fix the position in every direction
};

/// Moves the scan's points (robot frame) onto the map's surfaces, beginning at `start`. A prior keeps the pose where the
/// surfaces say nothing; `noise_m` is the standard deviation of a
/// point's distance to its surface. O(iterations * points).
PointMatch match_points(const PointMap& map, std::span<const SurfacePoint> scan, const Pose2& start, double noise_m,
                        const std::optional<PosePrior>& prior = std::nullopt);

}  // namespace outrider::slam_glue
