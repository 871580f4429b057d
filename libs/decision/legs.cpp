#include "decision/legs.hpp"

#include <cassert>

#include "world/task_set.hpp"

namespace outrider::decision {

Legs::Legs(const TopologicalMap& map, std::vector<int> goals, std::optional<int> home)
    : goals_(std::move(goals)), goal_at_(map.waypoints.size(), -1), home_(map.waypoints.size(), 0.0F) {
  assert(goals_.size() <= static_cast<std::size_t>(TaskSet::kMost));
  const std::size_t n = goals_.size(), places = map.waypoints.size();
  cost_.resize(places * n);
  for (std::size_t g = 0; g < n; ++g) {
    goal_at_[static_cast<std::size_t>(goals_[g])] = static_cast<int>(g);
    const std::vector<double> costs = expected_costs_to(map, goals_[g]);
    for (std::size_t w = 0; w < places; ++w) cost_[w * n + g] = static_cast<float>(costs[w]);
  }
  if (home) {
    const std::vector<double> costs = expected_costs_to(map, *home);
    for (std::size_t w = 0; w < places; ++w) home_[w] = static_cast<float>(costs[w]);
  }
  for (int a = 0; a < this->goals(); ++a)
    for (int b = 0; b < a; ++b) symmetric_ = symmetric_ && between(a, b) == between(b, a);
}

}  // namespace outrider::decision
