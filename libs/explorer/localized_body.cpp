#include "explorer/localized_body.hpp"

#include <cmath>
#include <utility>

namespace outrider::explorer {
namespace {

constexpr double kReached = 0.03;  // a way-point nearer than this is behind the robot [m]
constexpr double kPassed = 0.25;   // and so is one nearer than this when the robot is already on the way to the next [m]

}  // namespace

LocalizedBody::LocalizedBody(Body& inner, const RobotSpec& robot, PoseTracking tracking, const OdometryNoise& noise,
                             std::uint64_t seed)
    : inner_(inner), tracking_(std::move(tracking)), noise_(noise), random_(seed), T_true_(robot.start), T_odom_(robot.start),
      T_believed_(robot.start) {
  sensing_.pose = robot.start;
}

/// A true motion as the wheels report it.
Pose2 LocalizedBody::slipped(const Pose2& move) {
  const double way = std::hypot(move.x, move.y), turn = std::abs(move.theta);
  if (way == 0.0 && turn == 0.0) return move;
  const double shift = noise_.shift_per_sqrt_m * std::sqrt(way);
  const double turned = std::hypot(noise_.turn_per_sqrt_m * std::sqrt(way), noise_.turn_per_sqrt_rad * std::sqrt(turn));
  const double ex = shift * unit_(random_), ey = shift * unit_(random_), et = turned * unit_(random_);
  return {move.x + ex, move.y + ey, wrap_angle(move.theta + et)};
}

void LocalizedBody::locate(const PosedScan& scan) {
  const Pose2 before = T_odom_;
  T_odom_ = T_odom_ * slipped(inverse(T_true_) * scan.T_map_robot);
  T_true_ = scan.T_map_robot;
  if (tracking_) T_believed_ = tracking_(scan.scan, T_odom_);
  else T_believed_ = T_believed_ * (inverse(before) * T_odom_);
}

const Sensing& LocalizedBody::sense() {
  const Sensing& real = inner_.sense();
  sensing_.scans.clear();
  for (const PosedScan& scan : real.scans) {
    locate(scan);
    sensing_.scans.push_back({T_believed_, scan.scan});
  }
  // Since the last scan the robot goes by its wheels, which do not slip noticeably within a fraction of a second.
  const Pose2 T_believed_true = T_believed_ * inverse(T_true_);
  sensing_.pose = T_believed_true * real.pose;
  sensing_.sightings = real.sightings;
  for (Sighting& mate : sensing_.sightings) mate.position = T_believed_true * mate.position;
  sensing_.arrived = real.arrived;
  sensing_.blocked = real.blocked;
  if (real.arrived) way_.clear();
  if (!real.scans.empty() && !way_.empty()) drive();
  return sensing_;
}

void LocalizedBody::follow(std::span<const Point> way_points) {
  way_.assign(way_points.begin(), way_points.end());
  drive();
}

/// Hands on what is left of the way, as it looks from where the robot believes itself to be.
void LocalizedBody::drive() {
  const auto behind = [at = sensing_.pose.position()](Point a, Point next) {
    const double apart = distance(a, at);
    const double onwards = (at.x - a.x) * (next.x - a.x) + (at.y - a.y) * (next.y - a.y);
    return apart < kReached || (apart < kPassed && onwards > 0.0);
  };
  std::size_t passed = 0;
  while (passed + 1 < way_.size() && behind(way_[passed], way_[passed + 1])) ++passed;
  way_.erase(way_.begin(), way_.begin() + static_cast<std::ptrdiff_t>(passed));
  const Pose2 T_true_believed = T_true_ * inverse(T_believed_);
  std::vector<Point> real;
  for (const Point p : way_) real.push_back(T_true_believed * p);
  inner_.follow(real);
}

}  // namespace outrider::explorer
