#include "slam_glue/keyframe_graph.hpp"

#include <algorithm>
#include <cmath>

namespace outrider::slam_glue {
namespace {

constexpr double kPointSpacing = 0.03;  // along a scan [m]
constexpr double kFarView = 8.0;        // echoes from farther away say little about where a scan looks [m]

enum class Verdict { kSilent, kAgrees, kConflicts };

/// What one scan says about a point, given in its sensor's frame.
Verdict verdict(const LaserScan& scan, const SurfacePoint& q, const SightLimits& limits) {
  const Point p = q.p;
  const double range = std::hypot(p.x, p.y);
  const double beam = wrap_angle(std::atan2(p.y, p.x) - scan.angle_min) / scan.angle_increment;
  const auto n = static_cast<double>(scan.ranges.size());
  const double turn = std::abs(2.0 * kPi / scan.angle_increment);
  const double b = std::round(beam < -0.5 ? beam + turn : beam);
  if (b < 1.0 || b > n - 2.0) return Verdict::kSilent;
  // A grazed wall moves far along the beam when it moves a little.
  const double facing =
      limits.square && q.has_normal() && range > 0.0 ? std::abs(q.normal.x * p.x + q.normal.y * p.y) / range : 1.0;
  bool through = true;
  for (int k = -1; k <= 1; ++k) {
    const auto i = static_cast<std::size_t>(b + k);
    if (!scan.valid(i)) {
      through = false;
      continue;
    }
    const double r = scan.ranges[i];
    if (std::abs(r - range) < limits.near_m + limits.near_slope * range) return Verdict::kAgrees;
    through = through && facing * (r - range) > limits.through_m + limits.through_slope * range;
  }
  return through ? Verdict::kConflicts : Verdict::kSilent;
}

}  // namespace

Keyframe make_keyframe(const LaserScan& scan, double max_range_m) {
  Keyframe frame;
  frame.t = scan.t;
  frame.scan = scan;
  frame.points = surface_points(scan, max_range_m, kPointSpacing);
  double weight = 0.0;
  for (const auto& q : frame.points) {
    const double r = std::hypot(q.p.x, q.p.y), w = std::min(1.0, kFarView / std::max(r, 0.1));
    frame.view = {frame.view.x + w * q.p.x, frame.view.y + w * q.p.y};
    weight += 1.0;
  }
  if (weight > 0.0) frame.view = {frame.view.x / weight, frame.view.y / weight};
  return frame;
}

std::pair<std::size_t, std::size_t> KeyframeGraph::neighbours(std::size_t k, std::size_t before,
                                                              std::size_t after) const {
  std::size_t begin = k, end = k + 1;
  while (begin > 0 && k - begin < before && frames[begin - 1].session == frames[k].session) --begin;
  while (end < size() && end - k <= after && frames[end].session == frames[k].session) ++end;
  return {begin, end};
}

std::vector<SurfacePoint> KeyframeGraph::gather(std::size_t begin, std::size_t end, std::size_t of) const {
  std::vector<SurfacePoint> points;
  for (std::size_t i = begin; i < end; ++i) {
    const Pose2 T = inverse(poses[of]) * poses[i];
    for (const auto& q : frames[i].points) points.push_back(T * q);
  }
  return points;
}

namespace {

std::vector<Pose2> sensors_from(const KeyframeGraph& graph, std::span<const std::size_t> frames, std::size_t of) {
  std::vector<Pose2> T_sensor_of;
  for (const std::size_t i : frames)
    T_sensor_of.push_back(inverse(graph.poses[i] * graph.frames[i].scan.T_robot_sensor) * graph.poses[of]);
  return T_sensor_of;
}

}  // namespace

Visibility judge(const KeyframeGraph& graph, std::span<const std::size_t> frames, std::size_t of,
                 std::span<const SurfacePoint> points, std::vector<bool>* agrees) {
  Visibility v;
  v.points = points.size();
  const std::vector<Pose2> T_sensor_of = sensors_from(graph, frames, of);
  for (const auto& q : points) {
    bool conflict = false, agree = false;
    for (std::size_t n = 0; n < frames.size() && !agree; ++n) {
      const Verdict said = verdict(graph.frames[frames[n]].scan, T_sensor_of[n] * q, SightLimits{});
      agree = said == Verdict::kAgrees;
      conflict = conflict || said == Verdict::kConflicts;
    }
    if (agree)
      ++v.agree;
    else if (conflict)
      ++v.conflict;
    if (agrees) agrees->push_back(agree);
  }
  return v;
}

std::vector<Sightings> sightings(const KeyframeGraph& graph, std::span<const std::size_t> frames, std::size_t of,
                                 std::span<const SurfacePoint> points, const SightLimits& limits) {
  std::vector<Sightings> seen(points.size());
  const std::vector<Pose2> T_sensor_of = sensors_from(graph, frames, of);
  for (std::size_t n = 0; n < frames.size(); ++n)
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Verdict said = verdict(graph.frames[frames[n]].scan, T_sensor_of[n] * points[i], limits);
      seen[i].there += said == Verdict::kAgrees;
      seen[i].through += said == Verdict::kConflicts;
    }
  return seen;
}

}  // namespace outrider::slam_glue
