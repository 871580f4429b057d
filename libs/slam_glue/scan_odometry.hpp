#pragma once
// Internal: wheel odometry corrected by matching scans with each other.

#include <cstdint>
#include <optional>
#include <vector>

#include "slam_glue/logs.hpp"

namespace outrider::slam_glue {

/// Correlative scan matching (Olson 2009) against a recent scan. Wheels can be wrong by 20 degrees in a quick turn, far
/// beyond the reach of ICP; trying every turn of a wide window is not. Drifts like any odometry, only less.
class ScanOdometry {
 public:
  ScanOdometry();
  /// T_odom_robot at this scan. O(turns * shifts * points), about 0.2 ms.
  Pose2 add(const LogEntry& entry);

 private:
  struct Window;
  void set_reference(const Pose2& pose);
  double score(const Pose2& T_reference_robot, std::size_t stride) const;
  Pose2 best(const Pose2& guess, const Window& window) const;

  std::vector<std::uint8_t> field_;  ///< nearness to a point of the reference scan, 0..255
  std::vector<Point> points_;        ///< of the current scan, in the robot's frame
  std::optional<Pose2> wheels_;      ///< at the last scan
  bool has_wheels_ = false;          ///< whether the wheels have ever moved
  Pose2 pose_;                       ///< corrected, at the last scan
  Pose2 reference_;                  ///< corrected, where the reference scan was taken
};

}  // namespace outrider::slam_glue
