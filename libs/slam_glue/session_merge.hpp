#pragma once
// Internal: several logs become one map. A placement is found or given, checked against everything that both sides saw,
// and refused when in doubt.

#include <optional>
#include <string>
#include <vector>

#include "slam_glue/joint_graph.hpp"
#include "slam_glue/slam.hpp"

namespace outrider::slam_glue {

struct MergeSettings {
  LoopSettings loops;
  std::size_t least_supports = 3;   ///< places that lead to the same placement
  double rival = 0.6;               ///< weight of the second placement, relative to the first's: ambiguous
  double least_place_agreement = 0.7;  ///< of a single place: people walk, doors open
  double least_agreement = 0.85;    ///< of what both sides could judge, seen alike
  double least_hit_ratio = 0.5;     ///< of the walls in the space that both saw, on walls of the other
  double least_overlap_m2 = 4.0;    ///< of walls that both saw
  /// With unknown starts, see CommonGround. Of the logs at hand right merges miss at most 0.11, sides that look alike 0.16
  /// and more; a place that was changed much between two visits (wean1, wean2: 0.38) is refused too.
  double most_missing = 0.13;
  double least_landmarks_m2 = 1.2;
};

/// Places the sessions one after the other onto session 0, which stays where it is. Sessions with a
/// given start (`starts_known`) must lie there already. Changes the poses of what is placed. One record a session but the
/// first, in their order.
std::vector<MergeRecord> merge_sessions(JointGraph& joint, bool starts_known, const MergeSettings& settings = {});

}  // namespace outrider::slam_glue
