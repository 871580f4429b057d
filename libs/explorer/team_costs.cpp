#include "explorer/team_costs.hpp"

#include <limits>

namespace outrider::explorer {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

}  // namespace

TeamCosts::TeamCosts(const decision::TopoMission& mission, bool return_home, std::optional<int> exact_up_to)
    : mission_(mission), diameter_(decision::diameter(mission.map)) {
  for (const auto& robot : mission.robots) {
    const decision::TopologicalMap& map = robot.own ? *robot.own : mission.map;
    seats_.push_back({plan_for(map, return_home ? std::optional(robot.at) : std::nullopt, exact_up_to), robot.at});
  }
}

std::size_t TeamCosts::plan_for(const decision::TopologicalMap& map, std::optional<int> home,
                                std::optional<int> exact_up_to) {
  for (std::size_t k = 0; k < plans_.size(); ++k)
    if (plans_[k].map == &map && plans_[k].home == home) return k;
  Plan plan{&map, home, {}, true, nullptr};
  std::vector<int> goals, places;
  for (std::size_t g = 0; g < mission_.goals.size(); ++g) {
    const int w = mission_.goals[g];
    const auto own = &map == &mission_.map ? std::optional(w) : map.find(mission_.map.waypoints[static_cast<std::size_t>(w)].id);
    plan.local.push_back(own ? static_cast<int>(goals.size()) : -1);
    plan.whole = plan.whole && own;
    if (own) goals.push_back(*own);
  }
  for (const auto& robot : mission_.robots)
    if ((robot.own ? robot.own.get() : &mission_.map) == &map) places.push_back(robot.at);
  plan.planner = std::make_unique<decision::GoalPlanner>(map, std::move(goals), std::move(places), home, exact_up_to);
  plans_.push_back(std::move(plan));
  return plans_.size() - 1;
}

std::optional<TaskSet> TeamCosts::localise(const Plan& plan, const TaskSet& tasks) const {
  if (plan.whole) return tasks;
  TaskSet own;
  bool all = true;
  tasks.for_each([&](int g) {
    if (const int k = plan.local[static_cast<std::size_t>(g)]; k >= 0) own.insert(k);
    else all = false;
  });
  return all ? std::optional(own) : std::nullopt;
}

double TeamCosts::cost(int robot, const TaskSet& tasks) {
  const Plan& plan = plan_of(robot);
  const auto own = localise(plan, tasks);
  return own ? plan.planner->cost(waypoint(robot, -1), *own) / speed(robot) : kNever;
}

double TeamCosts::lower_bound(int robot, const TaskSet& tasks) {
  const Plan& plan = plan_of(robot);
  const auto own = localise(plan, tasks);
  return own ? plan.planner->lower_bound(waypoint(robot, -1), *own) / speed(robot) : kNever;
}

int TeamCosts::waypoint(int robot, int from) const {
  const Plan& plan = plan_of(robot);
  if (from < 0) return seats_[static_cast<std::size_t>(robot)].at;
  return plan.planner->legs().waypoint(plan.local[static_cast<std::size_t>(from)]);
}

double TeamCosts::leg(int robot, int from, int task) const {
  const Plan& plan = plan_of(robot);
  const int own = plan.local[static_cast<std::size_t>(task)];
  return own < 0 ? kNever : plan.planner->legs().from(waypoint(robot, from), own) / speed(robot);
}

double TeamCosts::home(int robot, int from) const {
  return plan_of(robot).planner->legs().home(waypoint(robot, from)) / speed(robot);
}

std::vector<int> TeamCosts::order(int robot, const TaskSet& tasks) {
  const Plan& plan = plan_of(robot);
  const auto own = localise(plan, tasks);
  if (!own) return {};
  std::vector<int> visits = plan.planner->order(waypoint(robot, -1), *own);
  if (plan.whole) return visits;
  for (int& g : visits)
    for (std::size_t task = 0; task < plan.local.size(); ++task)
      if (plan.local[task] == g) {
        g = static_cast<int>(task);
        break;
      }
  return visits;
}

std::size_t TeamCosts::solves() const {
  std::size_t sum = 0;
  for (const Plan& plan : plans_) sum += plan.planner->solves();
  return sum;
}

}  // namespace outrider::explorer
