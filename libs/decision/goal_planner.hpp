#pragma once
// J_i(S) for any number of goals: exact as far as that is affordable, a heuristic with a bound beyond.

#include <map>
#include <optional>
#include <unordered_map>

#include "decision/go_mdp.hpp"
#include "decision/tours.hpp"

namespace outrider::decision {

/// The default of GoalPlanner: sets of up to this many goals are solved exactly, out of `goals` in all. Every question
/// of an auction is about one set and each goal more, so its cost grows with 2^|S| |G|.
int exact_size(int goals);

/// Costs of goal sets on one map, for robots that share it. Every answer is a fixed function of (waypoint, set).
class GoalPlanner {
 public:
  /// `map` must outlive this. `exact_up_to`: sets with more goals are left to the heuristic.
  GoalPlanner(const TopologicalMap& map, std::vector<int> goals, std::vector<int> places, std::optional<int> home,
              std::optional<int> exact_up_to = {});

  const Legs& legs() const { return mdp_.legs(); }
  bool exact(const TaskSet& goals) const { return goals.size() <= exact_up_to_; }
  /// J(w, S), or its upper bound by TourHeuristic; infinity when S cannot be done from there. Memoised.
  double cost(int waypoint, const TaskSet& goals);
  /// J(w, S) or a lower bound of it. On maps with deviation the heuristic's bound holds for tours that commit to a goal.
  double lower_bound(int waypoint, const TaskSet& goals);
  /// The visiting order behind cost().
  std::vector<int> order(int waypoint, const TaskSet& goals);
  /// What to do at `waypoint`: index of a path, -1 when done or stuck.
  int best_path(int waypoint, const TaskSet& goals);
  /// Policies computed so far: different (waypoint, set).
  std::size_t solves() const { return solves_; }
  GoMdp& mdp() { return mdp_; }

 private:
  const TopologicalMap& map_;
  GoMdp mdp_;
  TourHeuristic tours_;
  int exact_up_to_;
  std::map<int, std::unordered_map<TaskSet, double, TaskSet::Hash>> memo_;  // by waypoint
  std::size_t solves_ = 0;
};

}  // namespace outrider::decision
