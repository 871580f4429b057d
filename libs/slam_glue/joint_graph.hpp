#pragma once
// Internal: the keyframes of several logs in one pose graph.

#include <span>
#include <vector>

#include "slam_glue/keyframe_graph.hpp"
#include "slam_glue/logs.hpp"
#include "slam_glue/loop_closing.hpp"

namespace outrider::slam_glue {

/// One log's graph, in the frame of its first pose, with the closures found in it.
struct SessionGraph {
  KeyframeGraph graph;
  std::vector<LoopClosure> closures;
};

/// Keyframes along a trajectory that some other method has found: a chain of edges that trusts it.
SessionGraph session_graph(const LogReader& reader, std::span<const TimedPose> trajectory, double max_range_m);

/// All sessions one after the other. Sessions that are not placed keep their own frame and have no edge to the others.
struct JointGraph {
  KeyframeGraph graph;
  std::vector<std::size_t> begin;  ///< first frame of each session; begin[n] = all frames
  std::vector<LoopClosure> closures;

  explicit JointGraph(std::vector<SessionGraph> sessions);
  std::size_t sessions() const { return begin.size() - 1; }
  /// Moves a whole session: T_new_old from the left.
  void move(std::size_t session, const Pose2& T_new_old);
  /// Moves the scans of a session as its keyframes were moved since `before` (poses of all frames); between two
  /// keyframes the correction is interpolated. `trajectory`: one pose a scan.
  void carry(std::size_t session, std::span<const Pose2> before, std::span<TimedPose> trajectory) const;
};

}  // namespace outrider::slam_glue
