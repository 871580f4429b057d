#pragma once
// A world of straight walls with an exact lidar, for SLAM tests.

#include <limits>
#include <random>
#include <vector>

#include "slam_glue/logs.hpp"

namespace outrider::test {

struct Wall {
  Point a, b;
};

class SegmentWorld {
 public:
  explicit SegmentWorld(std::vector<Wall> walls) : walls_(std::move(walls)) {}

  double range(Point from, double angle) const {
    double nearest = std::numeric_limits<double>::infinity();
    const double c = std::cos(angle), s = std::sin(angle);
    for (const Wall& w : walls_) {
      const double ex = w.b.x - w.a.x, ey = w.b.y - w.a.y, ax = w.a.x - from.x, ay = w.a.y - from.y;
      const double det = ex * s - ey * c;
      if (std::abs(det) < 1e-12) continue;
      const double t = (ex * ay - ey * ax) / det, u = (c * ay - s * ax) / det;
      if (t > 0.0 && u >= 0.0 && u <= 1.0) nearest = std::min(nearest, t);
    }
    return nearest;
  }
  LaserScan scan(const Pose2& T_world_robot, double t, std::size_t beams, double aperture, std::mt19937& random,
                 double noise_m = 0.01) const {
    LaserScan scan;
    scan.t = t;
    scan.angle_min = -0.5 * aperture;
    scan.angle_increment = aperture / static_cast<double>(beams - 1);
    scan.range_max = 20.0;
    std::normal_distribution<double> noise(0.0, noise_m);
    for (std::size_t b = 0; b < beams; ++b)
      scan.ranges.push_back(static_cast<float>(
          range(T_world_robot.position(), T_world_robot.theta + scan.angle(b)) + noise(random)));
    return scan;
  }

 private:
  std::vector<Wall> walls_;
};

inline void add_box(std::vector<Wall>& walls, double x0, double y0, double x1, double y1) {
  walls.insert(walls.end(), {{{x0, y0}, {x1, y0}}, {{x1, y0}, {x1, y1}}, {{x1, y1}, {x0, y1}}, {{x0, y1}, {x0, y0}}});
}

/// A ring of corridors, 2 m wide, around a block; niches of different widths make every stretch its own.
inline SegmentWorld ring_world() {
  std::vector<Wall> walls;
  add_box(walls, 0.0, 0.0, 20.0, 14.0);
  add_box(walls, 2.0, 2.0, 18.0, 12.0);
  for (const auto& [x, y, w] : std::vector<std::array<double, 3>>{
           {4, 0, .4}, {9, 0, .8}, {13, 0, .3}, {5, 13.6, .9}, {11, 13.7, .5}, {15, 13.6, .3}})
    add_box(walls, x, y, x + w, y + 0.4);
  for (const auto& [x, y, w] : std::vector<std::array<double, 3>>{{0, 5, .5}, {0, 9, .9}, {19.7, 4, .4}, {19.6, 10, .7}})
    add_box(walls, x, y, x + 0.4, y + w);
  return SegmentWorld(walls);
}

/// Once round the ring and a quarter more, a scan every 0.2 m or 0.15 rad.
inline std::vector<Pose2> round_trip() {
  std::vector<Pose2> poses{{1.0, 1.0, 0.0}};
  const std::vector<Point> corners{{19, 1}, {19, 13}, {1, 13}, {1, 1}, {19, 1}};
  for (const Point& corner : corners) {
    Pose2 p = poses.back();
    const double heading = std::atan2(corner.y - p.y, corner.x - p.x), turn = wrap_angle(heading - p.theta);
    const int turns = static_cast<int>(std::ceil(std::abs(turn) / 0.15));
    for (int i = 1; i <= turns; ++i) poses.push_back({p.x, p.y, wrap_angle(p.theta + turn * i / turns)});
    const int steps = static_cast<int>(std::ceil(distance(p.position(), corner) / 0.2));
    for (int i = 1; i <= steps; ++i)
      poses.push_back({p.x + (corner.x - p.x) * i / steps, p.y + (corner.y - p.y) * i / steps, heading});
  }
  return poses;
}

/// What a robot logs along true poses: odometry that slips, scans with noise.
inline std::vector<LaserScan> scans_along(const SegmentWorld& world, const std::vector<Pose2>& poses, std::size_t beams,
                                          double aperture, std::mt19937& random) {
  std::vector<LaserScan> scans;
  for (std::size_t i = 0; i < poses.size(); ++i)
    scans.push_back(world.scan(poses[i], 0.2 * static_cast<double>(i), beams, aperture, random));
  return scans;
}

inline std::vector<Pose2> slipping_odometry(const std::vector<Pose2>& poses, double shift, double turn, double bias,
                                            std::mt19937& random) {
  std::vector<Pose2> odometry{{}};
  std::normal_distribution<double> normal;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    Pose2 move = inverse(poses[i - 1]) * poses[i];
    const double way = std::sqrt(std::hypot(move.x, move.y)), angle = std::sqrt(std::abs(move.theta));
    move = {move.x + shift * way * normal(random), move.y + shift * way * normal(random),
            move.theta * (1.0 + bias) + turn * (angle + 0.3 * way) * normal(random)};
    odometry.push_back(odometry.back() * move);
  }
  return odometry;
}

}  // namespace outrider::test
