#pragma once
// Internal: places seen before. A candidate is searched for exhaustively, checked against what both visits saw, and
// believed only when it hardly changes the map or when a second one, some way on, says the same.

#include <optional>
#include <string>
#include <vector>

#include "slam_glue/keyframe_graph.hpp"

namespace outrider::slam_glue {

struct LoopClosure {
  std::size_t from = 0, to = 0;  ///< keyframes
  Pose2 T_from_to;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double share = 0.0;         ///< of the later visit's points that lie on surfaces of the earlier
  double agreement = 0.0;     ///< of the points that both visits can judge
  double correction_m = 0.0;  ///< how far it moved the later visit when found
  std::string why;            ///< not believed because; empty = accepted
  bool accepted() const { return why.empty(); }
};

struct LoopSettings {
  double drift_m = 0.02, drift_rad = 0.006;  ///< of scan matching, per metre driven
  double least_radius_m = 0.4, most_radius_m = 12.0;
  double view_m = 3.0;    ///< two scans look at the same place when the middles of their views are this near
  double recent_m = 6.0;  ///< the way back that is the local map's business, not a loop
  double least_share = 0.45, least_agreement = 0.75;
  double sure_agreement = 0.88;  ///< from here on a small correction needs no second witness
  double rival = 0.9;            ///< a second place that fits at least so well (share of the best score): ambiguous
  double small_m = 0.3, small_rad = 0.06;  ///< corrections that need no second witness
  double witness_m = 1.5;                  ///< way between a candidate and its witness
};

/// How far two keyframes may have drifted apart.
struct Drift {
  double way_m = 0.0;                               ///< driven with matching scans between them
  Eigen::Matrix3d blind = Eigen::Matrix3d::Zero();  ///< covariance of what was driven blindly, (x, y, theta)
};

class LoopCloser {
 public:
  explicit LoopCloser(const LoopSettings& settings) : settings_(settings) {}

  /// Looks for earlier visits of what keyframe `k` sees and adds edges for those that are believed; with
  /// `other_sessions` only for visits by other robots. Returns whether the graph should be optimised now.
  bool look(KeyframeGraph& graph, std::size_t k, bool other_sessions = false);

  /// One pair of keyframes: searched for as far as they may have drifted, matched and checked, but not believed yet.
  /// Absent when there is nothing like it.
  std::optional<LoopClosure> check(KeyframeGraph& graph, std::size_t j, std::size_t k, const Drift& drift);

  /// Whether keyframe `k` is tied to an earlier visit of which a keyframe is kept that stood where it stands. O(k).
  bool shown_before(const KeyframeGraph& graph, std::size_t k) const;

  /// Adds the closure's edge.
  void accept(KeyframeGraph& graph, const LoopClosure& closure);

  /// Takes over what was found before; the edges are in the graph already.
  void adopt(const std::vector<LoopClosure>& closures);

  /// Optimises; loop edges that disagree with the rest afterwards are dropped, and it is optimised again.
  void optimise(KeyframeGraph& graph, const std::vector<std::size_t>& fixed = {0});

  /// Everything that came near to being a loop; candidates without a witness are refused for good.
  std::vector<LoopClosure> closures(const KeyframeGraph& graph) const;

 private:
  std::vector<Drift> drift_from(const KeyframeGraph& graph, std::size_t k) const;
  double radius(const Drift& drift) const;
  double turn(const Drift& drift) const;
  /// Keyframe `k` searches as far as the place may lie off; that is dear where it is vague.
  bool looks_widely(std::size_t k, const Drift& drift) const;
  std::vector<std::size_t> candidates(const KeyframeGraph& graph, std::size_t k, const std::vector<Drift>& drift,
                                      bool other_sessions) const;
  bool witness(const KeyframeGraph& graph, const LoopClosure& a, const LoopClosure& b) const;

  LoopSettings settings_;
  std::vector<LoopClosure> accepted_, refused_, pending_;
};

}  // namespace outrider::slam_glue
