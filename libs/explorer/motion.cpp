// Explorer's legs: planning a way and driving it.

#include <algorithm>
#include <cmath>

#include "explorer/explorer.hpp"

namespace outrider::explorer {
namespace {

constexpr double kTouch = 1e-9;          // [m]
constexpr std::size_t kTrail = 512;      // cells

double distance_to_square(Point p, Point center, double half) {
  return std::hypot(std::max(std::abs(p.x - center.x) - half, 0.0), std::max(std::abs(p.y - center.y) - half, 0.0));
}

}  // namespace

bool Explorer::plan(Cell stand) {
  std::vector<Cell> way = board_.path_to(base(), stand);
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
  held_ = false;
  status_news_ = true;
}

bool Explorer::has_reached(Cell stand) const {
  const Point there = map_.states().geometry().center(stand);
  return arrived_ && !held_ && (here() == stand || distance(pose_.position(), there) <= spec_.radius);
}

void Explorer::stop() {
  way_.clear();
  held_ = false;
  body_.follow({});
  status_news_ = true;
}

/// Drops the cells that the robot has passed.
void Explorer::trim_way() {
  const Cell at = here();
  const auto passed = std::find(way_.begin(), way_.end(), at);
  if (passed != way_.end()) way_.erase(way_.begin(), passed);
}

void Explorer::note_trail() {
  if (!trail_.empty() && trail_.back() == here()) return;
  trail_.push_back(here());
  if (trail_.size() > kTrail) trail_.erase(trail_.begin(), trail_.begin() + kTrail / 2);
}

bool Explorer::way_is_passable() const {
  return std::all_of(way_.begin(), way_.end(), [&](Cell c) { return passable_.passable(c); });
}

}  // namespace outrider::explorer
