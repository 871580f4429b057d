#include "slam_glue/consistency.hpp"

#include <algorithm>
#include <cmath>

#include "slam_glue/surface_points.hpp"
#include "world/ray.hpp"

namespace outrider::slam_glue {
namespace {

constexpr double kSpacing = 0.05;          // of the end points looked at [m]
constexpr double kBefore = 0.25;           // a wall nearer to the end than this is the end's own [m]
constexpr double kBeside = 0.3;            // a cell seen at a flatter angle than this (sine) is grazed, not passed
constexpr double kNear = 0.15, kFar = 0.7; // how far before a wall its double may stand [m]
constexpr double kSameWay = 0.9;           // cosine between the normals of a wall and its double

double length(Point v) { return std::hypot(v.x, v.y); }
double dot(Point a, Point b) { return a.x * b.x + a.y * b.y; }
double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole);
}

bool is_wall(const OccupancyGrid& map, Cell c) { return map.contains(c) && map[c] == CellState::kOccupied; }

bool wall_beside(const OccupancyGrid& map, Cell c) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (is_wall(map, {c.x + dx, c.y + dy})) return true;
  return false;
}

/// `normals`: which way the surfaces in a cell face.
bool passes_wall(const OccupancyGrid& map, const Grid<Point>& normals, Point from, Point to) {
  const double d = distance(from, to);
  if (d <= kBefore) return false;
  const Point way{(to.x - from.x) / d, (to.y - from.y) / d};
  bool passed = false;
  walk_ray(map.geometry(), from, way.x, way.y, d - kBefore, [&](Cell c, double) {
    // Along a wall every beam grazes cells of it.
    passed = map[c] == CellState::kOccupied && std::abs(dot(normals[c], way)) > kBeside * length(normals[c]);
    return !passed;
  });
  return passed;
}

bool has_double(const OccupancyGrid& map, const Grid<Point>& normals, std::size_t i) {
  const GridGeometry& g = map.geometry();
  const double size = length(normals[i]);
  const Point n{normals[i].x / size, normals[i].y / size}, p = g.center(g.cell_at(i));
  for (double d = std::max(kNear, 3.0 * g.resolution); d <= kFar; d += g.resolution) {
    const Cell c = g.cell_of({p.x + d * n.x, p.y + d * n.y});
    if (is_wall(map, c) && dot(n, normals[c]) > kSameWay * length(normals[c])) return true;
  }
  return false;
}

}  // namespace

void ConsistencyCheck::add(const LaserScan& scan, const Pose2& T_map_robot) {
  ++scans_;
  const Point from = (T_map_robot * scan.T_robot_sensor).position();
  for (const SurfacePoint& q : surface_points(scan, max_range_m_, kSpacing))
    beams_.push_back({from, T_map_robot * q});
}

SelfConsistency ConsistencyCheck::result(const OccupancyGrid& map) const {
  Grid<Point> normals(map.geometry());
  for (const Beam& b : beams_) {
    const Cell c = map.geometry().cell_of(b.end.p);
    if (!map.contains(c)) continue;
    normals[c] = {normals[c].x + b.end.normal.x, normals[c].y + b.end.normal.y};
  }
  std::size_t agree = 0, through = 0, walls = 0, doubled = 0;
  for (const Beam& b : beams_) {
    agree += wall_beside(map, map.geometry().cell_of(b.end.p));
    through += passes_wall(map, normals, b.from, b.end.p);
  }
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] != CellState::kOccupied || length(normals[i]) < 1e-9) continue;
    ++walls;
    doubled += has_double(map, normals, i);
  }
  return {scans_, share(agree, beams_.size()), share(through, beams_.size()), share(doubled, walls)};
}

}  // namespace outrider::slam_glue
