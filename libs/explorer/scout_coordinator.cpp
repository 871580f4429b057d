#include "explorer/scout_coordinator.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "decision/distance_field.hpp"
#include "world/ray.hpp"

namespace outrider::explorer {
namespace {

using decision::HopedWorld;
using decision::Tourist;
using decision::Tours;
using Node = HopedWorld::Node;

class ScoutCoordinator : public Coordinator {
 public:
  explicit ScoutCoordinator(const ScoutSettings& settings) : settings_(settings) {}

  Decision decide(const Situation& s) override {
    const bool arrived = s.task && s.at == s.task->stand;
    if (!s.needs_task && !(s.task && (s.now_s >= plan_at_s_ || arrived))) return {};
    plan_at_s_ = s.now_s + settings_.replan * s.spec.range / s.spec.speed;
    const std::vector<BidEntry> entries = s.tasks({.gains = false});
    if (entries.empty()) return {.verdict = s.task ? Decision::Verdict::kKeep : Decision::Verdict::kNothing};
    look(s, arrived);
    const auto task = next_task(s, entries, plan(s));
    if (!task) return {.verdict = s.task ? Decision::Verdict::kKeep : Decision::Verdict::kIdle};
    return {.verdict = Decision::Verdict::kGo, .task = task};
  }

 private:
  /// Brings the hoped-for world up to date. A stop for which we went to look twice without any news is hopeless.
  void look(const Situation& s, bool arrived) {
    double shortest = s.spec.range;
    for (const Teammate& mate : s.known) shortest = std::min(shortest, mate.status.range);
    if (!world_ || shortest < shortest_m_) {
      shortest_m_ = shortest;
      const auto& g = s.map.geometry();
      const double area = static_cast<double>(g.size()) * g.cell_area();
      const double block = std::max(settings_.block * shortest, std::sqrt(area / settings_.most_blocks));
      const auto cells = [&](double m) { return std::max(1, static_cast<int>(std::lround(m / g.resolution))); };
      world_ = std::make_unique<HopedWorld>(g, cells(block), cells(settings_.pixel * shortest));
      planner_ = std::make_unique<decision::TourPlanner>(*world_, settings_.plan);
      near_cells_ = 2 * cells(block);
      stops_.clear();
    }
    world_->update(s.map, s.passable.mask());
    world_->look_from(s.at);
    if (!arrived) return;
    if (world_->revision() == arrival_revision_ && !stops_[s.self].empty())
      if (const Node stop = world_->node_near(stops_[s.self][0], near_cells_); stop != HopedWorld::kNone)
        world_->give_up(world_->view(world_->range_class(s.spec.range), stop));
    arrival_revision_ = world_->revision();
  }

  /// Where a team-mate is now, if it drove on along the way that it told.
  static Cell predicted(const Situation& s, const Teammate& mate) {
    const auto& g = s.map.geometry();
    const Cell told = g.cell_of(mate.status.pose.position());
    if (mate.status.way.empty()) return told;
    const double driven = (s.now_s - mate.heard_s) * mate.status.speed;
    double length = 0.0;
    for (std::size_t k = 1; k < mate.status.way.size(); ++k) {
      length += distance(g.center(mate.status.way[k - 1]), g.center(mate.status.way[k]));
      if (length > driven) return mate.status.way[k - 1];
    }
    return mate.status.way.back();
  }

  /// Plans for everybody, in the order of their ids, so that robots that know the same plan the same. Returns the own
  /// tour.
  std::vector<Node> plan(const Situation& s) {
    std::vector<Tourist> team;
    Tours tours;
    std::vector<RobotId> robots;
    const auto join = [&](RobotId robot, Cell at, double speed, double range, std::optional<Cell> goal) {
      const Node node = world_->node_near(at, near_cells_);
      if (node == HopedWorld::kNone) return;
      robots.push_back(robot);
      team.push_back({node, speed, world_->range_class(range), goal.has_value()});
      auto& tour = tours.emplace_back();
      if (goal) add_stop(tour, *goal, node);
      for (const Cell c : stops_[robot])
        if (tour.size() < settings_.kept_stops) add_stop(tour, c, node);
    };
    bool joined = false;
    const auto join_self = [&] {
      if (!joined) join(s.self, s.at, s.spec.speed, s.spec.range, std::nullopt);
      joined = true;
    };
    for (const Teammate& mate : s.known) {
      if (mate.robot > s.self) join_self();
      if (mate.status.done || s.now_s > mate.heard_s + settings_.forget_s) continue;
      join(mate.robot, predicted(s, mate), mate.status.speed, mate.status.range, mate.status.goal);
    }
    join_self();
    planner_->begin(std::move(team));
    planner_->prune(tours);
    planner_->complete(tours);
    stops_.clear();
    for (std::size_t r = 0; r < robots.size(); ++r)
      for (const Node n : tours[r]) stops_[robots[r]].push_back(world_->place(n));
    const auto self = std::find(robots.begin(), robots.end(), s.self);
    return self == robots.end() ? std::vector<Node>() : tours[static_cast<std::size_t>(self - robots.begin())];
  }

  void add_stop(std::vector<Node>& tour, Cell c, Node start) const {
    const Node n = world_->node_near(c, near_cells_);
    if (n != HopedWorld::kNone && n != (tour.empty() ? start : tour.back())) tour.push_back(n);
  }

  /// The way of the own tour as far as it is known, and the frontier nearest to what comes then.
  std::optional<Task> next_task(const Situation& s, const std::vector<BidEntry>& entries,
                                const std::vector<Node>& tour) {
    const Cell source[] = {s.at};
    field_.compute(s.passable.mask(), source);
    Node at = world_->node_near(s.at, near_cells_);
    for (const Node stop : tour) {
      Cell stand = s.at, beyond = world_->place(stop);
      for (const Node n : planner_->leg(at, stop).nodes) {
        beyond = world_->place(n);
        if (!field_.reached(beyond)) break;
        stand = beyond;
      }
      if (const auto task = towards(s, entries, stand, beyond)) return task;
      at = stop;
    }
    return nearest_unreserved(s, entries);
  }

  /// The frontier nearest to `beyond`, to be looked at from `stand` when it can be seen from there.
  static std::optional<Task> towards(const Situation& s, const std::vector<BidEntry>& entries, Cell stand,
                                     Cell beyond) {
    const auto& g = s.map.geometry();
    const BidEntry* nearest = nullptr;
    double least = 0.0;
    for (const BidEntry& e : entries) {
      const double away = distance(g.center(e.task), g.center(beyond));
      if (e.stand == s.at || (nearest != nullptr && away >= least)) continue;  // from here it has been looked at
      nearest = &e;
      least = away;
    }
    if (nearest == nullptr) return std::nullopt;
    const bool in_view = distance(g.center(nearest->task), g.center(stand)) <= s.spec.range &&
                         line_of_sight(s.map, stand, nearest->task);
    return Task{nearest->task, in_view && stand != s.at ? stand : nearest->stand};
  }

  static std::optional<Task> nearest_unreserved(const Situation& s, const std::vector<BidEntry>& entries) {
    const auto& g = s.map.geometry();
    const BidEntry* nearest = nullptr;
    for (const BidEntry& e : entries) {
      const bool reserved = std::any_of(s.team.begin(), s.team.end(), [&](const Teammate& mate) {
        return mate.status.goal && distance(g.center(*mate.status.goal), g.center(e.task)) < mate.status.range;
      });
      if (!reserved && (nearest == nullptr || e.distance < nearest->distance)) nearest = &e;
    }
    if (nearest == nullptr) return std::nullopt;
    return Task{nearest->task, nearest->stand};
  }

  ScoutSettings settings_;
  std::unique_ptr<HopedWorld> world_;
  std::unique_ptr<decision::TourPlanner> planner_;
  decision::DistanceField field_;
  std::map<RobotId, std::vector<Cell>> stops_;  // of the last plan
  double shortest_m_ = 0.0;
  int near_cells_ = 1;
  std::uint64_t arrival_revision_ = 0;
  double plan_at_s_ = 0.0;
};

}  // namespace

std::unique_ptr<Coordinator> make_scout_coordinator(const ScoutSettings& settings) {
  return std::make_unique<ScoutCoordinator>(settings);
}

}  // namespace outrider::explorer
