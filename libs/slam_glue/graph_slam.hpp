#pragma once
// Internal: graph SLAM of one robot: scan matching against recent scans, loop closing, pose graph.

#include <optional>
#include <vector>

#include "slam_glue/correlative.hpp"
#include "slam_glue/joint_graph.hpp"
#include "slam_glue/keyframe_graph.hpp"
#include "slam_glue/loop_closing.hpp"
#include "slam_glue/point_matcher.hpp"
#include "slam_glue/slam.hpp"

namespace outrider::slam_glue {

/// How far the wheels are to be trusted, learnt from their disagreement with scan matching over some way: the wheels'
/// errors add up, those of matching do not.
class WheelNoise {
 public:
  /// Variances of the pose after a motion: along x and y [m^2], of the heading [rad^2].
  struct Variance {
    double shift, turn;
  };
  Variance of(const Pose2& move) const;
  /// `matched`: the same motion as the scans have it.
  void learn(const Pose2& move, const Pose2& matched);

 private:
  double shift_ = 0.01;  ///< per metre driven [m^2 / m]
  double turn_ = 0.03;   ///< per radian turned [rad^2 / rad]
};

struct GraphSettings {
  double max_range_m = 30.0;
  double keyframe_m = 0.5, keyframe_rad = 0.5;  ///< motion between two keyframes
  std::size_t recent = 10;                      ///< keyframes in the local map
  LoopSettings loops;
};

class GraphSlam {
 public:
  explicit GraphSlam(const GraphSettings& settings) : settings_(settings), closer_(settings.loops) {}

  /// Where the robot is at this scan, T_map_robot, as far as known now. The map frame
  /// is the robot's at the first scan. O(points) between keyframes.
  Pose2 add(const LaserScan& scan, const Pose2& odometry);
  /// Last optimisation, when the log has ended.
  void finish();

  /// Pose of every scan.
  std::vector<Pose2> poses() const;
  const KeyframeGraph& graph() const { return graph_; }
  /// Hands over what was built; nothing else may be asked afterwards.
  SessionGraph take() {
    auto found = closures();
    return {std::move(graph_), std::move(found)};
  }
  std::vector<LoopClosure> closures() const { return closer_.closures(graph_); }

 private:
  struct Tracked {
    std::size_t keyframe;  ///< the last one before
    Pose2 T_keyframe_robot;
  };
  PointMatch locate(const std::vector<SurfacePoint>& points, const Pose2& guess, const WheelNoise::Variance& doubt);
  std::optional<PointMatch> locate_anywhere(const std::vector<SurfacePoint>& points, const Pose2& guess) const;
  double lost_share() const;
  void add_keyframe(Keyframe frame, const Pose2& T_last_frame, const Eigen::Matrix3d& information, bool blind);
  void rebuild_local_map();

  GraphSettings settings_;
  KeyframeGraph graph_;
  LoopCloser closer_;
  WheelNoise wheels_;
  std::vector<Tracked> scans_;
  std::optional<Pose2> odometry_;  ///< at the last scan
  Pose2 velocity_;                 ///< last motion, for logs without odometry
  bool has_wheels_ = false;
  double usual_share_ = 0.8;
  int misses_ = 0;         ///< scans in a row that matched nothing
  double noise_m_ = 0.03;  ///< of a point's distance to its surface
  double path_m_ = 0.0;
  std::vector<Pose2> steps_;       ///< T_k_k+1 as matched
  std::optional<PointMap> local_;  ///< recent points, in the frame of the last keyframe
  std::vector<SurfacePoint> local_points_;
  std::optional<CorrelativeMatcher> local_search_;  ///< of local_points_, made when first needed
  Pose2 T_keyframe_wheels_;                         ///< the wheels' way since the last keyframe
  WheelNoise::Variance way_{0.0, 0.0};              ///< and its variance
};

/// As the report states them.
std::vector<ClosureRecord> records(const KeyframeGraph& graph, const std::vector<LoopClosure>& closures);

}  // namespace outrider::slam_glue
