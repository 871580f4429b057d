// Explorer's legs: planning a way, and what to do when team-mates stand in it.

#include <algorithm>
#include <cmath>

#include "explorer/explorer.hpp"

namespace outrider::explorer {
namespace {

constexpr double kPatience = 0.3;        // [s] blocked before anything is done about it
constexpr double kStuck = 3.0;           // [s] blocked before detours are given up and room is asked for
constexpr double kTryAgain = 0.5;        // [s] between attempts
constexpr double kGiveUp = 15.0;         // [s] blocked before the task is given back
constexpr double kRoomTimeout = 8.0;     // [s] that room is made for somebody
constexpr double kWorthDetour = 4.0;     // [m] a detour may always cost this much
constexpr double kNearby = 10.0;         // [m] team-mates farther away do not matter
constexpr int kIdlePriority = 1000;

constexpr double kTouch = 1e-9;          // [m]

double distance_to_square(Point p, Point center, double half) {
  return std::hypot(std::max(std::abs(p.x - center.x) - half, 0.0), std::max(std::abs(p.y - center.y) - half, 0.0));
}

double length(const std::vector<Cell>& way, double resolution) {
  double cells = 0.0;
  for (std::size_t k = 1; k < way.size(); ++k) cells += std::hypot(way[k].x - way[k - 1].x, way[k].y - way[k - 1].y);
  return cells * resolution;
}

}  // namespace

int Explorer::base_priority() const {
  return task_ || phase_ == Phase::kReturning ? self_ : kIdlePriority + self_;
}

bool Explorer::plan(Cell stand) {
  std::vector<Cell> way = board_.path_to(passable_.mask(), base(), stand);
  if (way.empty()) return false;
  drive(std::move(way));
  return true;
}

/// No occupied cell's square is nearer than the radius to the straight way: exact, on the cells around it.
bool Explorer::safe_straight(Point from, Point to) const {
  const auto& g = map_.states().geometry();
  const double r = spec_.radius - kTouch, half = g.resolution / 2.0;
  const Cell lo = g.cell_of({std::min(from.x, to.x) - r, std::min(from.y, to.y) - r});
  const Cell hi = g.cell_of({std::max(from.x, to.x) + r, std::max(from.y, to.y) + r});
  for (int y = lo.y; y <= hi.y; ++y)
    for (int x = lo.x; x <= hi.x; ++x) {
      if (!g.contains({x, y})) return false;
      if (map_.states()[Cell{x, y}] != CellState::kOccupied) continue;
      const Point c = g.center({x, y});
      // The segment and the square are convex: they are nearest at an end of the one or a corner of the other, unless
      // the segment crosses the square; then its distance from the centre is less than half an edge.
      double gap = std::min(distance_to_square(from, c, half), distance_to_square(to, c, half));
      for (const double sx : {-half, half})
        for (const double sy : {-half, half})
          gap = std::min(gap, decision::distance_to_segment({c.x + sx, c.y + sy}, from, to));
      if (gap < r || decision::distance_to_segment(c, from, to) < half) return false;
    }
  return true;
}

/// No team-mate in view is touched on the straight way, unless it is as near already and the way leads off.
bool Explorer::clear_of_team(Point from, Point to) const {
  return std::all_of(sightings_.begin(), sightings_.end(), [&](const Sighting& mate) {
    const double gap = decision::distance_to_segment(mate.position, from, to);
    return gap >= spec_.radius + mate.radius - kTouch || gap >= distance(mate.position, from) - kTouch;
  });
}

/// The cell that planning starts from: passable, and its centre can be reached in a straight line. Usually the cell
/// the robot is in, but a robot between two centres may be in a third one whose centre it cannot visit, and pressed
/// against a team-mate it has to begin on the other side.
Cell Explorer::base() const {
  const auto& g = map_.states().geometry();
  const Cell at = here();
  std::optional<Cell> best;
  bool best_clear = false;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const Cell c{at.x + dx, at.y + dy};
      if (!g.contains(c) || !passable_.passable(c) || !safe_straight(pose_.position(), g.center(c))) continue;
      const bool clear = clear_of_team(pose_.position(), g.center(c));
      const bool nearer =
          !best || distance(g.center(c), pose_.position()) < distance(g.center(*best), pose_.position()) - kTouch;
      if (clear == best_clear ? !nearer : !clear) continue;
      best = c;
      best_clear = clear;
    }
  return best.value_or(at);
}

void Explorer::drive(std::vector<Cell> way) {
  way_ = std::move(way);
  const auto& g = map_.states().geometry();
  std::vector<Point> points;
  points.reserve(way_.size());
  for (const Cell c : way_) points.push_back(g.center(c));
  // Between two cells, do not turn back to the first one's centre when the second can be reached directly.
  if (points.size() > 1 && safe_straight(pose_.position(), points[1]) && clear_of_team(pose_.position(), points[1]))
    points.erase(points.begin());
  body_.follow(points);
  arrived_ = false;
  status_news_ = true;
}

void Explorer::stop() {
  way_.clear();
  body_.follow({});
  status_news_ = true;
}

/// Drops the cells that the robot has passed.
void Explorer::trim_way() {
  const Cell at = here();
  const auto passed = std::find(way_.begin(), way_.end(), at);
  if (passed != way_.end()) way_.erase(way_.begin(), passed);
}

bool Explorer::way_is_passable() const {
  return std::all_of(way_.begin(), way_.end(), [&](Cell c) { return passable_.passable(c); });
}

std::vector<decision::Neighbour> Explorer::neighbours() const {
  std::vector<decision::Neighbour> result;
  for (const Sighting& sighting : sightings_) {
    if (distance(sighting.position, pose_.position()) > kNearby) continue;
    decision::Neighbour n{sighting.robot, sighting.position, sighting.radius, {}, kIdlePriority + sighting.robot, {}};
    const auto mate = std::find_if(team_.begin(), team_.end(), [&](const Teammate& t) { return t.robot == n.robot; });
    if (mate != team_.end()) {
      n.way = mate->status.way;
      n.priority = mate->status.priority;
      n.asks = mate->status.asks;
    }
    result.push_back(std::move(n));
  }
  return result;
}

/// Makes room for a team-mate that asks for it and goes first.
void Explorer::give_way(double now_s) {
  const auto around = neighbours();
  if (making_room_for_) {
    const auto asker = std::find_if(around.begin(), around.end(),
                                    [&](const auto& n) { return n.robot == *making_room_for_; });
    const bool still_asks = asker != around.end() && (asker->asks == self_ || (!asker->way.empty() && !arrived_));
    if (still_asks && now_s < making_room_until_s_) return;
    making_room_for_.reset();
    asks_.reset();
    priority_ = base_priority();
    blocked_since_s_ = -1.0;
    status_news_ = true;
    if (task_ && !plan(task_->stand)) end_task("no way", now_s);
    else if (!task_ && phase_ != Phase::kReturning) stop();
    else if (!task_) arrived_ = true;  // go_home() plans again
    return;
  }
  for (const auto& n : around) {
    if (n.asks != self_ || n.priority >= priority_) continue;
    const auto room = traffic_.make_room(passable_.mask(), base(), n, around);
    if (!room) continue;
    making_room_for_ = n.robot;
    making_room_until_s_ = now_s + kRoomTimeout;
    priority_ = room->through_asker ? n.priority - 1 : n.priority;
    asks_ = room->ask;
    sink_(now_s, PhaseEvent{self_, "making room"});
    drive(room->path);
    return;
  }
}

/// Blocked by somebody: drive around, or ask to be let through, or in the end give the task back.
void Explorer::resolve_block(double now_s) {
  if (!blocked_ || way_.empty()) {
    if (blocked_since_s_ >= 0.0 && !making_room_for_) {
      blocked_since_s_ = -1.0;
      if (asks_) asks_.reset(), status_news_ = true;
    }
    return;
  }
  if (blocked_since_s_ < 0.0) blocked_since_s_ = now_s;
  if (now_s < blocked_since_s_ + kPatience || now_s < last_try_s_ + kTryAgain) return;
  last_try_s_ = now_s;
  trim_way();
  if (way_.empty()) return;
  if (now_s > blocked_since_s_ + kGiveUp && !making_room_for_) {
    blocked_since_s_ = -1.0;
    asks_.reset();
    if (task_) end_task("blocked", now_s);
    stop();
    return;
  }
  const auto around = neighbours();
  const double resolution = map_.states().geometry().resolution;
  const bool stuck = now_s > blocked_since_s_ + kStuck;  // a detour did not help
  if (const auto way = stuck ? std::nullopt : traffic_.detour(passable_.mask(), base(), way_.back(), around);
      way && length(*way, resolution) <= 2.0 * length(way_, resolution) + kWorthDetour) {
    if (!making_room_for_) asks_.reset();
    drive(*way);
    return;
  }
  const auto* first = traffic_.in_the_way(way_, around, kNearby);
  if (first != nullptr && asks_ != first->robot) {
    asks_ = first->robot;
    status_news_ = true;
  }
}

}  // namespace outrider::explorer
