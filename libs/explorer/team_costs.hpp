#pragma once
// What task sets cost each robot of a mission: the decision room's numbers in the shape that the auction room asks for.

#include <memory>
#include <optional>
#include <vector>

#include "decision/goal_planner.hpp"
#include "decision/topo_mission.hpp"

namespace outrider::explorer {

/// Robots with the same map (and home) share one planner. Costs are divided by a robot's speed: durations.
class TeamCosts {
 public:
  /// `mission` must outlive this. `exact_up_to`: see GoalPlanner.
  TeamCosts(const decision::TopoMission& mission, bool return_home, std::optional<int> exact_up_to = {});

  int robots() const { return static_cast<int>(seats_.size()); }
  int tasks() const { return static_cast<int>(mission_.goals.size()); }
  /// J_i(S) from where robot i stands; infinity when it cannot do S.
  double cost(int robot, const TaskSet& tasks);
  double lower_bound(int robot, const TaskSet& tasks);
  /// From the place of task `from` (-1: where it stands) to a task, or home (0 without a way home).
  double leg(int robot, int from, int task) const;
  double home(int robot, int from) const;
  std::vector<int> order(int robot, const TaskSet& tasks);
  double speed(int robot) const { return mission_.robots[static_cast<std::size_t>(robot)].speed; }
  /// D_max of the mission's map.
  double diameter() const { return diameter_; }
  /// Policies computed so far.
  std::size_t solves() const;

 private:
  struct Plan {
    const decision::TopologicalMap* map;
    std::optional<int> home;
    std::vector<int> local;  // number of each task among the planner's goals, -1: not on this map
    bool whole = true;       // local is the identity
    std::unique_ptr<decision::GoalPlanner> planner;
  };
  struct Seat {
    std::size_t plan;
    int at;
  };
  std::size_t plan_for(const decision::TopologicalMap& map, std::optional<int> home, std::optional<int> exact_up_to);
  std::optional<TaskSet> localise(const Plan& plan, const TaskSet& tasks) const;
  const Plan& plan_of(int robot) const { return plans_[seats_[static_cast<std::size_t>(robot)].plan]; }
  int waypoint(int robot, int from) const;

  const decision::TopoMission& mission_;
  std::vector<Plan> plans_;
  std::vector<Seat> seats_;
  double diameter_;
};

}  // namespace outrider::explorer
