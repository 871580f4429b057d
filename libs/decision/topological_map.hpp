#pragma once
// The topological map <W, P> of Lozenguez et al. 2015, section 3.3: waypoints connected by paths.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "world/geometry.hpp"

namespace outrider::decision {

/// Semantic state of a place by its exits (section 3.1, Fig. 2c). docs/missions.md has our reading of the figure.
enum class SemanticState {
  kFreeSpace,     ///< nothing in sight
  kOneObstacle,   ///< one obstacle, open all around it
  kDeadEnd,       ///< one exit at most, the way back
  kCorridor,      ///< two regular exits
  kFunnel,        ///< two exits, one of them open: a corridor ends
  kGate,          ///< two open exits: between two obstacles
  kJunction,      ///< three exits
  kIntersection,  ///< four exits or more
};
inline constexpr int kSemanticStates = 8;
std::string_view to_string(SemanticState state);
std::optional<SemanticState> semantic_state(std::string_view name);
/// Punctual states hold at a place and ask for a decision; stable ones hold along a way.
bool punctual(SemanticState state);

/// (x_w, y_w, theta_w, sp_w, id_w)
struct Waypoint {
  std::string id;  ///< unique; what files and results call it
  Pose2 pose;      ///< [m, rad]
  SemanticState state = SemanticState::kIntersection;
  int landmark = -1;  ///< id_w of the landmark detector; -1: none
};

/// sr_p: how a path is driven.
struct SupervisionRule {
  enum class Kind {
    kReach,  ///< Reaching Controller, to the pose of the target (or to the via points one after the other)
    kExit,   ///< Topological Controller, through exit `exit`, then on through what is stable
  };
  Kind kind = Kind::kReach;
  int exit = 0;  ///< counted from the left, 0 first
  friend bool operator==(const SupervisionRule&, const SupervisionRule&) = default;
};

struct Outcome {
  int waypoint = 0;
  double probability = 1.0;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};

/// (w_p, w'_p, sr_p, c_p, d_p)
struct Path {
  int from = 0, to = 0;  ///< w_p, w'_p as indices of TopologicalMap::waypoints
  SupervisionRule rule;
  double cost = 0.0;             ///< c_p > 0; the average duration, or the length at unit speed
  std::vector<Outcome> outcomes; ///< d_p: all waypoints that may be reached; sums to 1, `to` has the highest share
  std::vector<Point> via;        ///< bends between the ends [m]; empty: straight
};

struct TopologicalMap {
  std::vector<Waypoint> waypoints;
  std::vector<Path> paths;

  std::optional<int> find(std::string_view id) const;
  /// Indices of the paths that leave each waypoint.
  std::vector<std::vector<int>> outgoing() const;
  /// True when every path arrives for certain.
  bool deterministic() const;
};

/// A path that arrives for certain.
Path certain_path(int from, int to, double cost);

/// Least cost from every waypoint to `target` when each path may be taken with its best outcome (infinity: no way).
/// Exact for deterministic maps, a lower bound of the expected cost otherwise. Dijkstra, O(|P| log |W|).
std::vector<double> costs_to(const TopologicalMap& map, int target);

/// Least expected cost from every waypoint to `target`; infinity where it is not reached almost surely. Equals
/// costs_to() on deterministic maps; else Gauss-Seidel value iteration from below to a relative residual of 1e-9.
std::vector<double> expected_costs_to(const TopologicalMap& map, int target);

/// The largest finite cost between two waypoints, D_max.
double diameter(const TopologicalMap& map);

}  // namespace outrider::decision
