#pragma once
// What it costs to go from anywhere to each goal: all that deterministic tours need to know of a map.

#include <limits>
#include <optional>
#include <vector>

#include "decision/topological_map.hpp"

namespace outrider::decision {

inline constexpr float kNoWay = std::numeric_limits<float>::infinity();

/// Least expected costs D(w, g) between waypoints and goals. On maps with deviation D is the value of the policy that
/// commits itself to g, so that tours over D are upper bounds of the GO-MDP's optimum; else they are exact.
class Legs {
 public:
  /// `goals`: distinct waypoint indices, at most TaskSet::kMost. With `home`, a tour ends there. |goals| x Dijkstra.
  Legs(const TopologicalMap& map, std::vector<int> goals, std::optional<int> home = {});

  int goals() const { return static_cast<int>(goals_.size()); }
  int waypoint(int goal) const { return goals_[static_cast<std::size_t>(goal)]; }
  /// The goal at a waypoint, -1 if there is none.
  int goal_at(int waypoint) const { return goal_at_[static_cast<std::size_t>(waypoint)]; }
  float from(int waypoint, int goal) const {
    return cost_[static_cast<std::size_t>(waypoint) * goals_.size() + static_cast<std::size_t>(goal)];
  }
  float between(int goal, int next) const { return from(waypoint(goal), next); }
  /// D(w, home), 0 without home.
  float home(int waypoint) const { return home_[static_cast<std::size_t>(waypoint)]; }
  float home_from_goal(int goal) const { return home(waypoint(goal)); }
  /// True when D(g, h) = D(h, g) for all goals.
  bool symmetric() const { return symmetric_; }

 private:
  std::vector<int> goals_, goal_at_;
  std::vector<float> cost_;  // waypoint x goal
  std::vector<float> home_;  // by waypoint
  bool symmetric_ = true;
};

}  // namespace outrider::decision
