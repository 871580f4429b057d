#include "decision/goal_planner.hpp"

namespace outrider::decision {

int exact_size(int goals) { return goals <= 14 ? 14 : goals <= 20 ? 12 : 9; }

GoalPlanner::GoalPlanner(const TopologicalMap& map, std::vector<int> goals, std::vector<int> places,
                         std::optional<int> home, std::optional<int> exact_up_to)
    : map_(map), mdp_(map, std::move(goals), std::move(places), home), tours_(mdp_.legs()),
      exact_up_to_(exact_up_to.value_or(exact_size(mdp_.legs().goals()))) {}

double GoalPlanner::cost(int waypoint, const TaskSet& goals) {
  const auto [entry, fresh] = memo_[waypoint].try_emplace(goals, 0.0);
  if (!fresh) return entry->second;
  ++solves_;
  return entry->second = exact(goals) ? mdp_.cost(waypoint, goals) : tours_.tour(waypoint, goals).cost;
}

double GoalPlanner::lower_bound(int waypoint, const TaskSet& goals) {
  return exact(goals) ? cost(waypoint, goals) : tours_.lower_bound(waypoint, goals);
}

std::vector<int> GoalPlanner::order(int waypoint, const TaskSet& goals) {
  return exact(goals) ? mdp_.order(waypoint, goals) : tours_.tour(waypoint, goals).order;
}

int GoalPlanner::best_path(int waypoint, const TaskSet& goals) {
  if (exact(goals)) return mdp_.best_path(waypoint, goals);
  TaskSet rest = goals;
  if (const int g = legs().goal_at(waypoint); g >= 0) rest.erase(g);
  const std::vector<int> visits = order(waypoint, rest);
  if (visits.empty()) return mdp_.best_path(waypoint, rest);
  return mdp_.best_path(waypoint, TaskSet{}.with(visits.front()));
}

}  // namespace outrider::decision
