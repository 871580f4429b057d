#pragma once
// Internal: the SLAM methods behind one interface, without MRPT's headers.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "slam_glue/joint_graph.hpp"
#include "slam_glue/slam.hpp"

namespace outrider::slam_glue {

/// Scans in, poses out.
class Localizer {
 public:
  virtual ~Localizer() = default;
  /// Scans in the order of the log.
  virtual void add(const LogEntry& entry) = 0;
  /// The log has ended.
  virtual void finish() {}
  /// The final pose of every scan added, T_map_robot; the map frame is the robot's at the first scan.
  virtual std::vector<Pose2> poses() const = 0;
  /// Scans in the SLAM's own map so far.
  virtual std::size_t keyframes() = 0;
  /// The pose graph behind the poses, for methods that have one; once, after finish().
  virtual std::optional<SessionGraph> take_graph() { return std::nullopt; }
};

/// Each keyframe makes MRPT rebuild the search tree of its map, so keyframes are few and the map thin: with 2.5 times
/// the points CSAIL is no more accurate, but takes 3 times as long.
struct IcpSettings {
  double max_range_m = 30.0;
  double locate_every_m = 0.15, locate_every_rad = 0.1;  ///< motion between two matches
  double insert_every_m = 1.2, insert_every_rad = 1.2;   ///< motion between two keyframes
  double least_goodness = 0.25;
  unsigned max_iterations = 40;
  double threshold_m = 0.4, threshold_rad = 0.05;  ///< points pair up to threshold_m + range * threshold_rad [m]
  double smallest_threshold_m = 0.1;
  double shrink = 0.5;           ///< of the thresholds, after each convergence
  double point_spacing_m = 0.1;  ///< of the map
  unsigned decimation = 3;       ///< of a scan's points when matched
};
std::unique_ptr<Localizer> make_icp(const IcpSettings& settings);

struct RbpfSettings {
  double max_range_m = 30.0;
  int particles = 10;
  std::uint64_t seed = 1;
  double update_every_m = 1.0, update_every_rad = 0.6;  ///< motion between two updates of the filter
};
/// Seeds MRPT's random generator of the calling thread.
std::unique_ptr<Localizer> make_rbpf(const RbpfSettings& settings);

/// Scan matching, loop closing and pose graph (graph_slam.hpp).
std::unique_ptr<Localizer> make_graph(double max_range_m);

}  // namespace outrider::slam_glue
