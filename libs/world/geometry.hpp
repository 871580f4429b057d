#pragma once
// Poses and points in the map frame: metres, radians, x right, y up.

#include <cmath>
#include <numbers>

namespace outrider {

inline constexpr double kPi = std::numbers::pi;

struct Point {
  double x = 0.0;  ///< [m]
  double y = 0.0;  ///< [m]
  friend bool operator==(const Point&, const Point&) = default;
};

inline double distance(Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// The equivalent angle in (-pi, pi].
inline double wrap_angle(double a) {
  a = std::remainder(a, 2.0 * kPi);
  return a <= -kPi ? a + 2.0 * kPi : a;
}

/// A pose in the plane. Named T_frame_body: maps coordinates of `body` into `frame`.
struct Pose2 {
  double x = 0.0;      ///< [m]
  double y = 0.0;      ///< [m]
  double theta = 0.0;  ///< [rad]

  Point position() const { return {x, y}; }
  friend bool operator==(const Pose2&, const Pose2&) = default;
};

/// Composition T_a_c = T_a_b * T_b_c.
inline Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
  const double c = std::cos(T_a_b.theta), s = std::sin(T_a_b.theta);
  return {T_a_b.x + c * T_b_c.x - s * T_b_c.y, T_a_b.y + s * T_b_c.x + c * T_b_c.y,
          wrap_angle(T_a_b.theta + T_b_c.theta)};
}

inline Point operator*(const Pose2& T_a_b, Point p_b) {
  const double c = std::cos(T_a_b.theta), s = std::sin(T_a_b.theta);
  return {T_a_b.x + c * p_b.x - s * p_b.y, T_a_b.y + s * p_b.x + c * p_b.y};
}

inline Pose2 inverse(const Pose2& T) {
  const double c = std::cos(T.theta), s = std::sin(T.theta);
  return {-c * T.x - s * T.y, s * T.x - c * T.y, wrap_angle(-T.theta)};
}

/// A pose with the time at which it was held.
struct TimedPose {
  double t = 0.0;  ///< [s]
  Pose2 pose;      ///< T_map_robot
  friend bool operator==(const TimedPose&, const TimedPose&) = default;
};

}  // namespace outrider
