#include "explorer/topo_pilot.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#include "decision/grid_topology.hpp"

namespace outrider::explorer {
namespace {

constexpr double kLeft = 1.2;         // [m] from a waypoint that is left behind
constexpr double kSameExit = 0.9;     // [rad] between an exit as counted and as expected, at most
constexpr double kBeside = 0.8;       // [m] from a bend that is passed
constexpr double kProgress = 0.3;     // [m] nearer to the target is getting on
constexpr double kMateRadius = 0.25;  // [m]

double norm(Point p) { return std::hypot(p.x, p.y); }

}  // namespace

std::string_view to_string(PilotMode mode) {
  constexpr std::array<std::string_view, 4> kNames{"reaching", "topological", "waiting", "done"};
  return kNames[static_cast<std::size_t>(mode)];
}

TopoPilot::TopoPilot(const decision::TopologicalMap& map, decision::GoalPlanner& planner, int at, double theta,
                     const PilotSettings& settings)
    : map_(map), planner_(planner), settings_(settings), outgoing_(map.outgoing()),
      pose_{map.waypoints[static_cast<std::size_t>(at)].pose.x, map.waypoints[static_cast<std::size_t>(at)].pose.y, theta}, at_(at) {}

void TopoPilot::set_goals(const TaskSet& goals) {
  goals_ = goals;
  if (path_ < 0) mode_ = PilotMode::kWaiting;
}

int TopoPilot::heading_for() const { return path_ < 0 ? at_ : map_.paths[static_cast<std::size_t>(path_)].to; }

/// The landmark detector sets the estimate right; a waypoint within reach is where the robot is.
void TopoPilot::recognise(const PilotSensing& sensing, double now_s) {
  if (sensing.landmarks.empty()) return;
  const LandmarkSighting& seen = sensing.landmarks.front();
  pose_ = map_.waypoints[static_cast<std::size_t>(seen.waypoint)].pose * inverse(seen.T_robot_waypoint);
  if (norm(seen.T_robot_waypoint.position()) >= settings_.arrive_m) return;
  if (path_ < 0 || refuge_ || seen.waypoint != map_.paths[static_cast<std::size_t>(path_)].from) arrive(seen.waypoint, now_s);
}

void TopoPilot::arrive(int waypoint, double now_s) {
  at_ = waypoint;
  refuge_.reset();
  if (const int g = planner_.legs().goal_at(waypoint); g >= 0 && goals_.contains(g)) {
    goals_.erase(g);
    reached_ = g;
  }
  plan(now_s);
}

/// The policy's next path from the last recognised waypoint.
void TopoPilot::plan(double now_s) {
  if (const int g = planner_.legs().goal_at(at_); g >= 0 && goals_.contains(g)) {
    goals_.erase(g);
    reached_ = g;
  }
  path_ = planner_.best_path(at_, goals_);
  via_ = 0;
  leaving_ = true;
  progress_s_ = now_s;
  best_rest_ = 1e300;
  mode_ = path_ < 0 ? PilotMode::kDone : PilotMode::kReaching;
}

/// Stuck: the robot makes for a landmark in sight, or for the nearest waypoint by its belief, another one each time, and
/// plans anew from there.
void TopoPilot::get_lost(const PilotSensing& sensing, double now_s) {
  std::vector<int> near;
  for (const LandmarkSighting& seen : sensing.landmarks) near.push_back(seen.waypoint);
  if (near.empty()) {
    near.resize(map_.waypoints.size());
    std::iota(near.begin(), near.end(), 0);
    const auto away = [&](int w) { return distance(map_.waypoints[static_cast<std::size_t>(w)].pose.position(), pose_.position()); };
    std::stable_sort(near.begin(), near.end(), [&](int a, int b) { return away(a) < away(b); });
    near.resize(std::min<std::size_t>(near.size(), 4));
  }
  refuge_ = near[static_cast<std::size_t>(lost_) % near.size()];
  ++lost_;
  leaving_ = false;
  best_rest_ = 1e300;
  progress_s_ = now_s;
  last_heading_.reset();
}

/// The next bend of the path, or its end, in the robot frame as believed.
Point TopoPilot::target() const {
  if (refuge_) return inverse(pose_) * map_.waypoints[static_cast<std::size_t>(*refuge_)].pose.position();
  const decision::Path& path = map_.paths[static_cast<std::size_t>(path_)];
  const Point p = via_ < path.via.size() ? path.via[via_] : map_.waypoints[static_cast<std::size_t>(path.to)].pose.position();
  return inverse(pose_) * p;
}

/// True when the next bend is reached, or lies close behind.
bool TopoPilot::passed(const decision::Path& path) const {
  const Point bend = path.via[via_];
  const Point before = via_ > 0 ? path.via[via_ - 1] : map_.waypoints[static_cast<std::size_t>(path.from)].pose.position();
  const double beyond = (pose_.x - bend.x) * (bend.x - before.x) + (pose_.y - bend.y) * (bend.y - before.y);
  const double away = norm(target());
  return away < settings_.arrive_m || (away < kBeside && beyond > 0.0);
}

/// Chooses the controller by the semantic state: topological control in stable states and through the exits of punctual
/// ones, reaching control else.
std::optional<double> TopoPilot::steer(const PilotSensing& sensing) {
  decision::LocalView model = settings_.interpret(sensing.scan);
  state_ = model.state;
  for (const Point mate : sensing.team_mates) {  // round obstacles of their own
    decision::Obstacle disc;
    for (int k = 0; k < 12; ++k)
      disc.polygon.push_back({mate.x + kMateRadius * std::cos(k * kPi / 6), mate.y + kMateRadius * std::sin(k * kPi / 6)});
    model.obstacles.push_back(std::move(disc));
  }
  const decision::Path& path = map_.paths[static_cast<std::size_t>(path_)];
  const Point goal = target();
  const double bearing = std::atan2(goal.y, goal.x);
  const auto last = last_heading_ ? std::optional(wrap_angle(*last_heading_ - pose_.theta)) : std::nullopt;
  const decision::TopologicalController topological{settings_.reach};
  const auto& outgoing = outgoing_[static_cast<std::size_t>(path.from)];
  if (leaving_ && path.rule.kind == decision::SupervisionRule::Kind::kExit && model.exits.size() == outgoing.size()) {
    // Exit k counted from the left of a robot that looks as the waypoint does.
    std::vector<double> bearings;
    for (const decision::Exit& e : model.exits) bearings.push_back(e.bearing + pose_.theta);
    const auto order = decision::left_to_right(bearings, map_.waypoints[static_cast<std::size_t>(path.from)].pose.theta);
    const auto k = static_cast<std::size_t>(std::find(order.begin(), order.end(), path.rule.exit) - order.begin());
    if (k < order.size() && std::abs(wrap_angle(model.exits[k].bearing - bearing)) < kSameExit) {
      mode_ = PilotMode::kTopological;
      return topological.heading(model, k, last);
    }
  }
  const bool near = norm(goal) < settings_.interpret.range / 2.0;
  if (model.state == decision::SemanticState::kCorridor && !near && !refuge_)
    if (const auto k = decision::exit_towards(model, bearing); std::abs(wrap_angle(model.exits[*k].bearing - bearing)) < kSameExit) {
      mode_ = PilotMode::kTopological;
      return topological.heading(model, *k, last);
    }
  mode_ = PilotMode::kReaching;
  return settings_.reach.heading(model, goal, last);
}

std::optional<Point> TopoPilot::step(const PilotSensing& sensing, double now_s) {
  reached_.reset();
  pose_ = pose_ * sensing.T_last_robot;
  recognise(sensing, now_s);
  if (path_ < 0) plan(now_s);
  if (path_ < 0) return std::nullopt;
  const decision::Path& path = map_.paths[static_cast<std::size_t>(path_)];
  if (leaving_ && distance(pose_.position(), map_.waypoints[static_cast<std::size_t>(path.from)].pose.position()) > kLeft) leaving_ = false;
  while (!refuge_ && via_ < path.via.size() && passed(path)) ++via_;
  double rest = norm(target());
  for (std::size_t k = via_; !refuge_ && k < path.via.size(); ++k)
    rest += distance(path.via[k], k + 1 < path.via.size() ? path.via[k + 1] : map_.waypoints[static_cast<std::size_t>(path.to)].pose.position());
  if (rest < best_rest_ - kProgress) best_rest_ = rest, progress_s_ = now_s;
  if (now_s > progress_s_ + settings_.patience_s) get_lost(sensing, now_s);
  const auto heading = steer(sensing);
  if (!heading) return std::nullopt;
  last_heading_ = wrap_angle(pose_.theta + *heading);
  const double go = std::min(settings_.step_m, std::max(0.05, norm(target())));
  return Point{go * std::cos(*heading), go * std::sin(*heading)};
}

}  // namespace outrider::explorer
