#include "explorer/mission_execution.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <random>

#include "sim/simulator.hpp"
#include "world/error.hpp"
#include "world/ray.hpp"

namespace outrider::explorer {
namespace {

/// Odometer and landmark detector of one robot: what it is told of its true pose.
class Senses {
 public:
  Senses(const decision::TopologicalMap& map, const OccupancyGrid& truth, const ExecutionSettings& settings, int robot, const Pose2& at)
      : map_(map), truth_(truth), settings_(settings),
        random_(settings.seed * 0x9E3779B97F4A7C15U + static_cast<std::uint64_t>(robot)), last_(at), scale_(1.0 + settings.scale_drift * unit_(random_)) {}

  Pose2 odometer(const Pose2& T_map_robot) {
    const Pose2 step = inverse(last_) * T_map_robot;
    last_ = T_map_robot;
    const double metres = std::hypot(step.x, step.y);
    return {scale_ * step.x, scale_ * step.y, wrap_angle(step.theta + settings_.turn_drift * std::sqrt(metres) * unit_(random_))};
  }

  std::vector<LandmarkSighting> landmarks(const Pose2& T_map_robot) {
    std::vector<LandmarkSighting> seen;
    const auto& g = truth_.geometry();
    for (std::size_t w = 0; w < map_.waypoints.size(); ++w) {
      const Pose2& at = map_.waypoints[w].pose;
      if (map_.waypoints[w].landmark < 0 || distance(at.position(), T_map_robot.position()) > settings_.landmark_m ||
          !line_of_sight(truth_, g.cell_of(at.position()), g.cell_of(T_map_robot.position())))
        continue;
      Pose2 T = inverse(T_map_robot) * at;
      T.x += settings_.landmark_noise_m * unit_(random_);
      T.y += settings_.landmark_noise_m * unit_(random_);
      T.theta = wrap_angle(T.theta + settings_.landmark_noise_rad * unit_(random_));
      seen.push_back({static_cast<int>(w), T});
    }
    std::sort(seen.begin(), seen.end(), [](const auto& a, const auto& b) {
      return std::hypot(a.T_robot_waypoint.x, a.T_robot_waypoint.y) < std::hypot(b.T_robot_waypoint.x, b.T_robot_waypoint.y);
    });
    return seen;
  }

 private:
  const decision::TopologicalMap& map_;
  const OccupancyGrid& truth_;
  const ExecutionSettings& settings_;
  std::mt19937_64 random_;
  std::normal_distribution<double> unit_;
  Pose2 last_;
  double scale_;
};

std::vector<RobotSpec> bodies(const decision::TopoMission& mission, const ExecutionSettings& settings) {
  std::vector<RobotSpec> team;
  for (const auto& robot : mission.robots) {
    if (robot.own) throw InputError(robot.name + ": robots with maps of their own cannot be executed yet");
    RobotSpec spec = settings.robot;
    spec.name = robot.name;
    spec.speed *= robot.speed;
    spec.start = mission.map.waypoints[static_cast<std::size_t>(robot.at)].pose;
    for (const RobotSpec& other : team)
      if (distance(other.start.position(), spec.start.position()) < other.radius + spec.radius)
        throw InputError(robot.name + ": starts where " + other.name + " does; expected starts apart");
    team.push_back(spec);
  }
  return team;
}

class Execution {
 public:
  Execution(const OccupancyGrid& truth, const decision::TopoMission& mission, const ExecutionSettings& settings)
      : truth_(truth), mission_(mission), settings_(settings), sim_(truth, bodies(mission, settings), sim_options(settings)) {
    TeamCosts costs(mission, settings.allocation.return_home);
    result_.allocation = allocate(mission, costs, settings.allocation);
    const std::size_t n = mission.robots.size();
    result_.robots.resize(n);
    topological_.assign(n, 0);
    std::vector<int> starts;
    for (const auto& robot : mission.robots) starts.push_back(robot.at);
    for (std::size_t i = 0; i < n; ++i) {
      const auto home = settings.allocation.return_home ? std::optional(starts[i]) : std::nullopt;
      planners_.push_back(std::make_unique<decision::GoalPlanner>(mission.map, mission.goals, starts, home));
      const Pose2& at = sim_.pose(static_cast<RobotId>(i));
      pilots_.push_back(std::make_unique<TopoPilot>(mission.map, *planners_[i], starts[i], at.theta, settings.pilot));
      senses_.emplace_back(mission.map, truth_, settings, static_cast<int>(i), at);
      TaskSet goals;
      for (const int g : result_.allocation.order[i]) goals.insert(g);
      pilots_[i]->set_goals(goals);
    }
  }

  ExecutionResult run(const std::function<bool(double)>& going) {
    const double limit = settings_.most_s > 0.0
                             ? settings_.most_s
                             : 120.0 + 10.0 * result_.allocation.duration / std::max(settings_.robot.speed, 1e-6);
    while (sim_.now() < limit && !all_done()) {
      if (going && !going(sim_.now())) {
        result_.interrupted = true;
        break;
      }
      for (std::size_t i = 0; i < pilots_.size(); ++i) control(i);
      meet();
      sim_.step();
    }
    return finish();
  }

 private:
  static sim::SimOptions sim_options(const ExecutionSettings& s) {
    return {.dt = s.control_s, .lidar = true, .scan_rate = 1.0 / s.control_s, .range_noise = 0.01, .seed = s.seed};
  }
  bool all_done() const {
    return std::all_of(pilots_.begin(), pilots_.end(), [](const auto& p) { return p->done(); });
  }

  void control(std::size_t i) {
    const auto robot = static_cast<RobotId>(i);
    TopoPilot& pilot = *pilots_[i];
    const Sensing& sensing = sim_.body(robot).sense();
    const Pose2 T_map_robot = sensing.pose;
    if (sensing.scans.empty()) return;
    PilotSensing heard{senses_[i].odometer(T_map_robot), sensing.scans.back().scan, senses_[i].landmarks(T_map_robot), {}, sensing.blocked};
    for (const Sighting& mate : sensing.sightings) heard.team_mates.push_back(inverse(T_map_robot) * mate.position);
    const int before = pilot.at(), lost = pilot.lost();
    const auto way = pilot.step(heard, sim_.now());
    if (pilot.at() != before) event("waypoint", {static_cast<int>(i)}, pilot.at());
    if (pilot.lost() != lost) event("lost", {static_cast<int>(i)}, pilot.at());
    if (const auto goal = pilot.reached()) arrive(i, *goal, T_map_robot);
    topological_[i] += pilot.mode() == PilotMode::kTopological ? 1 : 0;
    std::vector<Point> command;
    if (way) command.push_back(T_map_robot * *way);
    sim_.body(robot).follow(command);
    ExecutedRobot& record = result_.robots[i];
    record.trajectory.push_back({sim_.now(), T_map_robot});
    record.believed.push_back({sim_.now(), pilot.pose()});
    record.worst_drift_m = std::max(record.worst_drift_m, distance(pilot.pose().position(), T_map_robot.position()));
  }

  void arrive(std::size_t i, int goal, const Pose2& T_map_robot) {
    const int w = mission_.goals[static_cast<std::size_t>(goal)];
    const double off = distance(mission_.map.waypoints[static_cast<std::size_t>(w)].pose.position(), T_map_robot.position());
    result_.worst_arrival_m = std::max(result_.worst_arrival_m, off);
    result_.robots[i].reached.push_back(goal);
    event("goal", {static_cast<int>(i)}, w);
  }

  void event(const char* what, std::vector<int> robots, int waypoint, int moved = 0) {
    result_.events.push_back({sim_.now(), what, std::move(robots), waypoint, moved});
  }

  /// Robots in touch re-open the auction over what is left of their goals (section 7).
  void meet() {
    if (settings_.rendezvous_m <= 0.0) return;
    const auto& g = truth_.geometry();
    for (std::size_t i = 0; i < pilots_.size(); ++i)
      for (std::size_t j = i + 1; j < pilots_.size(); ++j) {
        const Point a = sim_.pose(static_cast<RobotId>(i)).position(), b = sim_.pose(static_cast<RobotId>(j)).position();
        double& next_s = next_meeting_s_[{i, j}];
        if (sim_.now() < next_s || distance(a, b) > settings_.rendezvous_m || !line_of_sight(truth_, g.cell_of(a), g.cell_of(b))) continue;
        next_s = sim_.now() + settings_.rendezvous_pause_s;
        if (sim_.now() > 0.0) negotiate_again(i, j);
      }
  }

  /// From the waypoints that they head for; what the way there costs is the same for every set.
  void negotiate_again(std::size_t i, std::size_t j) {
    decision::TopoMission rest{mission_.map, {}, {}};
    std::vector<int> goals;
    for (const std::size_t k : {i, j}) {
      decision::TopoRobot robot = mission_.robots[k];
      robot.at = pilots_[k]->heading_for();
      robot.current.clear();
      pilots_[k]->goals().for_each([&](int goal) {
        robot.current.push_back(static_cast<int>(goals.size()));
        goals.push_back(goal);
        rest.goals.push_back(mission_.goals[static_cast<std::size_t>(goal)]);
      });
      rest.robots.push_back(std::move(robot));
    }
    if (goals.empty()) return;
    TeamCosts costs(rest, false);
    AllocationSettings again = settings_.allocation;
    again.protocol = Protocol::kDssa;
    again.initial = Initial::kCurrent;
    again.return_home = false;
    const AllocationResult agreed = allocate(rest, costs, again);
    if (!agreed.agreed || !agreed.undone.empty()) return;
    int moved = 0;
    for (std::size_t side = 0; side < 2; ++side) {
      TaskSet mine;
      for (const int g : agreed.order[side]) mine.insert(goals[static_cast<std::size_t>(g)]);
      TopoPilot& pilot = *pilots_[side == 0 ? i : j];
      if (side == 0) pilot.goals().for_each([&](int g) { moved += mine.contains(g) ? 0 : 1; });
      if (side == 0) mine.for_each([&](int g) { moved += pilot.goals().contains(g) ? 0 : 1; });
      pilot.set_goals(mine);
    }
    ++result_.rendezvous;
    result_.handed_over += moved;
    event("rendezvous", {static_cast<int>(i), static_cast<int>(j)}, -1, moved);
  }

  ExecutionResult finish() {
    TaskSet reached;
    for (std::size_t i = 0; i < pilots_.size(); ++i) {
      ExecutedRobot& record = result_.robots[i];
      record.path_m = sim_.path_m(static_cast<RobotId>(i));
      record.lost = pilots_[i]->lost();
      record.done = pilots_[i]->done();
      record.topological_share = record.trajectory.empty() ? 0.0 : topological_[i] / static_cast<double>(record.trajectory.size());
      for (const int g : record.reached) reached.insert(g);
    }
    for (int g = 0; g < static_cast<int>(mission_.goals.size()); ++g)
      if (!reached.contains(g)) result_.missed.push_back(g);
    result_.time_s = sim_.now();
    return std::move(result_);
  }

  const OccupancyGrid& truth_;
  const decision::TopoMission& mission_;
  const ExecutionSettings& settings_;
  sim::Simulator sim_;
  std::vector<std::unique_ptr<decision::GoalPlanner>> planners_;  // one a robot: homes differ
  std::vector<std::unique_ptr<TopoPilot>> pilots_;
  std::vector<Senses> senses_;
  std::vector<double> topological_;
  std::map<std::pair<std::size_t, std::size_t>, double> next_meeting_s_;
  ExecutionResult result_;
};

}  // namespace

ExecutionResult execute(const OccupancyGrid& truth, const decision::TopoMission& mission, const ExecutionSettings& settings,
                        const std::function<bool(double now_s)>& going) {
  return Execution(truth, mission, settings).run(going);
}

}  // namespace outrider::explorer
