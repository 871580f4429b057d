#pragma once
// A robot that localises itself while it maps: scan matching against its own map, for use while it drives.

#include <memory>

#include "world/geometry.hpp"
#include "world/scan.hpp"

namespace outrider::slam_glue {

/// Graph SLAM, one scan at a time. Not thread-safe; deterministic.
class PoseTracker {
 public:
  /// `start`: T_map_robot at the first scan. Echoes beyond `max_range_m` are not used.
  PoseTracker(const Pose2& start, double max_range_m);
  ~PoseTracker();
  PoseTracker(PoseTracker&&) noexcept;

  /// Where the robot is at this scan, T_map_robot, as far as known now. `odometry` is T_odom_robot, in any frame.
  Pose2 add(const LaserScan& scan, const Pose2& odometry);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace outrider::slam_glue
