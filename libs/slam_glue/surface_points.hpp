#pragma once
// A laser scan as points on surfaces: where a beam ended, and which way the surface there faces.

#include <span>
#include <vector>

#include "world/geometry.hpp"
#include "world/scan.hpp"

namespace outrider::slam_glue {

/// A point on a surface.
struct SurfacePoint {
  Point p;
  Point normal;  ///< unit, towards the sensor; (0, 0) where the surface's direction is unknown
  bool has_normal() const { return normal.x != 0.0 || normal.y != 0.0; }
};

inline Point rotate(double theta, Point v) {
  const double c = std::cos(theta), s = std::sin(theta);
  return {c * v.x - s * v.y, s * v.x + c * v.y};
}
inline SurfacePoint operator*(const Pose2& T, const SurfacePoint& q) { return {T * q.p, rotate(T.theta, q.normal)}; }

/// End points of the valid beams up to `max_range_m`, in the robot's frame and in the order of the beams. Of points
/// nearer to each other than `spacing_m` one is kept, so that near walls do not outvote far ones. Normals are fitted to
/// the neighbours along the sweep. O(beams).
std::vector<SurfacePoint> surface_points(const LaserScan& scan, double max_range_m, double spacing_m);

/// At most one point of each square of `cell_m`, the first; keeps the order. O(n log n).
std::vector<SurfacePoint> thinned(std::span<const SurfacePoint> points, double cell_m);

/// The points within `reach_m` of `centre`.
std::vector<SurfacePoint> within(std::span<const SurfacePoint> points, Point centre, double reach_m);

}  // namespace outrider::slam_glue
