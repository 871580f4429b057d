#pragma once
// A body that does not know where it is: what the mind hears and commands goes through the robot's own estimate.

#include <cstdint>
#include <functional>
#include <random>
#include <vector>

#include "world/body.hpp"
#include "world/scan.hpp"

namespace outrider::explorer {

enum class Localization {
  kPerfect,   ///< the simulator's own poses
  kOdometry,  ///< wheels that slip, nothing else
  kSlam,      ///< wheels that slip, and scan matching against the robot's own map
};

/// Where a robot believes itself to be, T_map_robot, at each of its scans; `T_odom_robot` is in any frame.
using PoseTracking = std::function<Pose2(const LaserScan& scan, const Pose2& T_odom_robot)>;
/// Makes the tracking of a robot that begins at its spec's start.
using TrackingFactory = std::function<PoseTracking(const RobotSpec&)>;

/// How wrong wheels are. Errors are normal and independent from step to step, so they add up like a random walk.
struct OdometryNoise {
  double shift_per_sqrt_m = 0.03;    ///< of the position, after 1 m [m]; grows with the root of the way
  double turn_per_sqrt_m = 0.02;     ///< of the heading, after 1 m [rad]
  double turn_per_sqrt_rad = 0.03;   ///< of the heading, after a turn of 1 rad [rad]
};

/// Stands between a body in its true world and a mind that lives in the map frame as the robot believes it. The start is
/// known. Poses of scans, the present pose and team-mates in sight come out in the believed frame; way-points come in
/// in it, and are handed on anew with every look, as a controller that watches its own estimate would drive. The wheels
/// are reckoned from scan to scan. Only lidar bodies: the cell sensor has no poses. Deterministic for a seed.
class LocalizedBody final : public Body {
 public:
  /// `inner` must outlive this. Without `tracking` the robot goes by odometry alone.
  LocalizedBody(Body& inner, const RobotSpec& robot, PoseTracking tracking, const OdometryNoise& noise,
                std::uint64_t seed);

  const Sensing& sense() override;
  void follow(std::span<const Point> way_points) override;

  const Pose2& believed() const { return sensing_.pose; }

 private:
  void locate(const PosedScan& scan);
  Pose2 slipped(const Pose2& move);
  void drive();

  Body& inner_;
  PoseTracking tracking_;
  OdometryNoise noise_;
  std::mt19937_64 random_;
  std::normal_distribution<double> unit_;
  Pose2 T_true_, T_odom_, T_believed_;  ///< of the robot, at the last scan
  std::vector<Point> way_;  ///< still to drive, in the believed frame
  Sensing sensing_;
};

}  // namespace outrider::explorer
