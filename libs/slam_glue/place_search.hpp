#pragma once
// Internal: where in a map a log was taken, without a guess. Places along the log are searched for exhaustively, each on
// its own; a placement is believed the more, the more places agree on it.

#include <vector>

#include "slam_glue/correlative.hpp"
#include "slam_glue/joint_graph.hpp"

namespace outrider::slam_glue {

/// A place of the log found in the map.
struct PlaceHit {
  std::size_t place = 0;  ///< number along the log
  std::size_t frame = 0;  ///< in the joint graph
  Pose2 T_map_robot;      ///< of that frame
  double score = 0.0;     ///< of the search, 0..1
};

/// One hypothesis, and the places that agree with it.
struct Placement {
  Pose2 T_map_session;  ///< moves the session's present poses into the map
  std::vector<PlaceHit> support;
  double weight = 0.0;  ///< sum of the scores
};

struct PlaceSearch {
  double spacing_m = 2.0;        ///< between places, along the way
  std::size_t most_places = 30;  ///< long logs are searched more sparsely
  double least_score = 0.45;     ///< of a hit
  double agree_m = 0.4, agree_rad = 0.08;  ///< between two hits, at once
  double drift_m = 0.02, drift_rad = 0.006;  ///< and more per metre of way between them
};

/// The hit that most others agree with, as far as the sessions' drift allows, together with them: one a place.
Placement best_placement(const JointGraph& joint, const std::vector<PlaceHit>& hits, const PlaceSearch& search);

/// Where session `s` may lie in the map of the `placed` sessions, by weight, the best first; at most two, the second with
/// places that do not agree with the first. `start`: its present poses are right to within a metre and a few degrees, so
/// only the neighbourhood is searched. Deterministic. About 0.1 s a place.
std::vector<Placement> find_placements(const JointGraph& joint, const std::vector<bool>& placed, std::size_t s,
                                       bool start_known, const PlaceSearch& search = {});

}  // namespace outrider::slam_glue
