#include "slam_glue/surface_points.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace outrider::slam_glue {
namespace {

constexpr int kNeighbours = 6;          // on either side, along the sweep
constexpr double kSurfaceReach = 0.12;  // neighbours on the same surface are nearer than this plus a few beams [m]
constexpr int kMostNeighbours = 20;     // and on the second try, over a longer stretch
constexpr double kLongReach = 0.3;
constexpr double kNoisy = 0.4;  // a smaller share of points on straight stretches is noise
constexpr double kFlat = 0.15;  // a line's smaller standard deviation is below this share of its larger

struct Echo {
  std::size_t beam;
  double range;
  Point p;
};

/// Direction of the line through the echoes within `reach` of `i`, at most `most` on either side, as a normal towards
/// the sensor; zero where they do not lie on a line.
Point normal_at(const std::vector<Echo>& echoes, std::size_t i, Point sensor, double reach, int most) {
  const Point p = echoes[i].p;
  const auto n = static_cast<int>(echoes.size()), at = static_cast<int>(i);
  double sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0, syy = 0.0;
  int count = 0;
  const auto take = [&](int j) {
    const Point q = echoes[static_cast<std::size_t>(j)].p;
    const double x = q.x - p.x, y = q.y - p.y;
    if (x * x + y * y > reach * reach) return false;
    sx += x, sy += y, sxx += x * x, sxy += x * y, syy += y * y;
    ++count;
    return true;
  };
  take(at);
  for (int j = at - 1; j >= std::max(0, at - most) && take(j);) --j;
  for (int j = at + 1; j <= std::min(n - 1, at + most) && take(j);) ++j;
  if (count < 3) return {};
  const double cxx = sxx / count - sx * sx / count / count, cyy = syy / count - sy * sy / count / count;
  const double cxy = sxy / count - sx * sy / count / count;
  const double mean = 0.5 * (cxx + cyy), root = std::hypot(0.5 * (cxx - cyy), cxy);
  if (mean - root > kFlat * kFlat * (mean + root)) return {};
  const double along = 0.5 * std::atan2(2.0 * cxy, cxx - cyy);
  Point normal{-std::sin(along), std::cos(along)};
  if (normal.x * (sensor.x - p.x) + normal.y * (sensor.y - p.y) < 0.0) normal = {-normal.x, -normal.y};
  return normal;
}

}  // namespace

std::vector<SurfacePoint> surface_points(const LaserScan& scan, double max_range_m, double spacing_m) {
  std::vector<Echo> echoes;
  for (std::size_t b = 0; b < scan.ranges.size(); ++b) {
    const double r = scan.ranges[b], a = scan.angle(b);
    if (!scan.valid(b) || r > max_range_m) continue;
    echoes.push_back({b, r, scan.T_robot_sensor * Point{r * std::cos(a), r * std::sin(a)}});
  }
  const Point sensor = scan.T_robot_sensor.position();
  const auto normals_of = [&](const Echo& echo, std::size_t i, double reach, int most) {
    return normal_at(echoes, i, sensor, reach + 3.0 * echo.range * std::abs(scan.angle_increment), most);
  };
  std::vector<SurfacePoint> points;
  std::vector<std::size_t> chosen;
  std::size_t flat = 0;
  for (std::size_t i = 0; i < echoes.size(); ++i) {
    if (!points.empty() && distance(points.back().p, echoes[i].p) < spacing_m) continue;
    points.push_back({echoes[i].p, normals_of(echoes[i], i, kSurfaceReach, kNeighbours)});
    chosen.push_back(i);
    flat += points.back().has_normal();
  }
  // Noise bends short stretches: where it bends most of them, longer ones are tried. Elsewhere these would only give
  // clutter a direction.
  if (static_cast<double>(flat) < kNoisy * static_cast<double>(points.size()))
    for (std::size_t n = 0; n < points.size(); ++n)
      if (!points[n].has_normal())
        points[n].normal = normals_of(echoes[chosen[n]], chosen[n], kLongReach, kMostNeighbours);
  return points;
}

std::vector<SurfacePoint> thinned(std::span<const SurfacePoint> points, double cell_m) {
  std::vector<std::pair<std::int64_t, std::size_t>> keys;
  keys.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto x = static_cast<std::int64_t>(std::floor(points[i].p.x / cell_m));
    const auto y = static_cast<std::int64_t>(std::floor(points[i].p.y / cell_m));
    keys.emplace_back((x << 32) + y, i);
  }
  std::sort(keys.begin(), keys.end());
  std::vector<std::size_t> kept;
  for (std::size_t k = 0; k < keys.size(); ++k)
    if (k == 0 || keys[k].first != keys[k - 1].first) kept.push_back(keys[k].second);
  std::sort(kept.begin(), kept.end());
  std::vector<SurfacePoint> result;
  result.reserve(kept.size());
  for (const std::size_t i : kept) result.push_back(points[i]);
  return result;
}

std::vector<SurfacePoint> within(std::span<const SurfacePoint> points, Point centre, double reach_m) {
  std::vector<SurfacePoint> near;
  for (const SurfacePoint& q : points)
    if (distance(q.p, centre) < reach_m) near.push_back(q);
  return near;
}

}  // namespace outrider::slam_glue
