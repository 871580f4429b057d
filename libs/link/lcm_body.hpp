#pragma once
// A real body behind LCM: drivers publish bot_core's planar_lidar_t and pose_t, and take paths or velocities.

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "link/multicast.hpp"
#include "link/rejection.hpp"
#include "world/body.hpp"

namespace outrider::link {

struct LcmBodySettings {
  std::string laser = "LASER", pose = "POSE";           ///< channels in
  std::string path = "PATH", velocity = "VELOCITY";     ///< channels out
  Pose2 T_robot_sensor;
  double speed = 0.5;        ///< [m/s]
  double range_max = 5.0;    ///< of the laser [m]
  double arrive_m = 0.2;     ///< nearer than this to the last way-point the robot has arrived [m]
};

/// A scan of planar_lidar_t, or a pose of pose_t, from an LCM payload; nothing when its lengths or values are off. Nothing
/// is allocated before the lengths have been compared.
std::optional<LaserScan> parse_planar_lidar(std::span<const std::uint8_t> payload, double range_max);
std::optional<Pose2> parse_pose(std::span<const std::uint8_t> payload);

/// Speed and turn rate that pursue the first point of a path; points that have been reached are dropped. {0, 0} at the end.
struct Velocity {
  double linear = 0.0;   ///< [m/s]
  double angular = 0.0;  ///< [rad/s]
};
Velocity pursue(const Pose2& pose, std::vector<Point>& path, double speed, double arrive_m);

/// Driver messages are believed: keep them on a network of their own (ttl=0). The path is published anew whenever it
/// changes, the velocity at every sense(). Not thread-safe.
class LcmBody : public Body {
 public:
  LcmBody(const MulticastUrl& url, LcmBodySettings settings);
  const Sensing& sense() override;
  void follow(std::span<const Point> way_points) override;
  bool has_pose() const { return has_pose_; }
  double path_m() const { return path_m_; }
  const RejectionCounters& rejections() const { return rejections_; }

 private:
  void hear(std::span<const std::uint8_t> datagram);
  void move_to(const Pose2& pose);
  template <class Wire>
  void publish(const std::string& channel, const Wire& wire);

  LcmBodySettings settings_;
  MulticastSocket socket_;
  std::vector<Point> path_;
  Sensing gathering_, delivered_;
  RejectionCounters rejections_;
  std::uint32_t sequence_ = 0;
  bool has_pose_ = false;
  double path_m_ = 0.0;
};

}  // namespace outrider::link
