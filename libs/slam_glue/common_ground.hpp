#pragma once
// Internal: what two sides of a merge say of the space that both saw.

#include <vector>

#include "slam_glue/keyframe_graph.hpp"

namespace outrider::slam_glue {

/// What the scans of one side say of the other side's walls. Much of a wrong placement agrees: a corridor fits on every
/// corridor. So what counts is what pins a place down: *landmarks*, lasting surfaces that face along the way on which
/// the place could slide, seen by both; and what is *missing*, lasting surfaces that the other side looked through.
/// Lasting means that its own side saw it more than once and did not look through it: not somebody who walked by.
struct CommonGround {
  Visibility seen;
  std::size_t common = 0, common_hits = 0;  ///< points of frames that look at common space, and those that agree
  double walls_m2 = 0.0;                    ///< cells of the points that agree
  double landmarks_m2 = 0.0, missing_m2 = 0.0;

  double missing() const {
    const double all = landmarks_m2 + missing_m2;
    return all > 0.0 ? missing_m2 / all : 0.0;
  }
};

/// Every second frame of the sessions `whose`, judged by those of `by`. O(frames * points of a frame * judges).
CommonGround common_ground(const KeyframeGraph& graph, const std::vector<bool>& whose, const std::vector<bool>& by);

/// Frames of the sessions `wanted` that see what `k` sees, nearest views first.
std::vector<std::size_t> frames_around(const KeyframeGraph& graph, std::size_t k, const std::vector<bool>& wanted);

}  // namespace outrider::slam_glue
