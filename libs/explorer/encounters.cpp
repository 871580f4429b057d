// What Explorer does about team-mates in its way: local coordination, right of way, making room.

#include <algorithm>
#include <cmath>

#include "explorer/explorer.hpp"

namespace outrider::explorer {
namespace {

constexpr double kPatience = 0.3;        // [s] blocked before anything is done about it
constexpr double kStuck = 3.0;           // [s] blocked before detours are given up and room is asked for
constexpr double kTryAgain = 0.5;        // [s] between attempts
constexpr double kGiveUp = 15.0;         // [s] blocked before the task is given back
constexpr double kDeferred = 20.0;       // [s] until a task that was blocked is tried again
constexpr int kMostRetreats = 4;         // from the silent, for one task
constexpr int kMostBlocked = 3;          // times that a task is given back before it is given up
constexpr double kRoomTimeout = 8.0;     // [s] that room is made for somebody, beside the way there
constexpr double kMostWait = 6.0;        // [s] that a close team-mate is waited for
constexpr double kNoWait = 10.0;         // [s] after that in which nobody is waited for
constexpr double kGoAgain = 0.2;         // [m] farther away than close, who was waited for counts as gone
constexpr double kLookAhead = 0.5;       // [m] on the way to where a robot is heading
constexpr double kWorthDetour = 4.0;     // [m] a detour may always cost this much
constexpr double kRejoin = 20.0;         // [m] a detour comes back to the way after no more than this of it
constexpr double kNearby = 10.0;         // [m] team-mates farther away do not matter
constexpr double kTouching = 0.05;       // [m] between bodies
constexpr double kStraightOn = 5.0;      // [m]
constexpr int kMostAside = 8;            // times that a robot with nothing to do steps aside for the silent
constexpr int kIdlePriority = 1000;

double length(const std::vector<Cell>& way, double resolution) {
  double cells = 0.0;
  for (std::size_t k = 1; k < way.size(); ++k) cells += std::hypot(way[k].x - way[k - 1].x, way[k].y - way[k - 1].y);
  return cells * resolution;
}

}  // namespace

int Explorer::base_priority() const {
  return task_ || phase_ == Phase::kReturning ? self_ : kIdlePriority + self_;
}

/// Team-mates in view. What they said counts as long as they are heard; of the silent only the place is known, and
/// everybody goes first whose number is lower.
std::vector<decision::Neighbour> Explorer::neighbours(double now_s) const {
  std::vector<decision::Neighbour> result;
  for (const Sighting& sighting : sightings_) {
    if (distance(sighting.position, pose_.position()) > kNearby) continue;
    decision::Neighbour n{sighting.robot, sighting.position, sighting.radius, {}, sighting.robot, {}};
    const auto mate = std::lower_bound(team_.begin(), team_.end(), n.robot,
                                       [](const Teammate& t, RobotId robot) { return t.robot < robot; });
    if (mate != team_.end() && mate->robot == n.robot && now_s <= mate->heard_s + settings_.silent_after) {
      n.way = mate->status.way;
      n.priority = mate->status.priority;
      n.asks = mate->status.asks;
      n.heard = true;
    }
    result.push_back(std::move(n));
  }
  return result;
}

/// Drives to where `asker` can pass; false when there is no such place.
bool Explorer::make_room(const decision::Neighbour& asker, std::span<const decision::Neighbour> around, double now_s) {
  const auto room = traffic_.make_room(passable_.mask(), base(), asker, around);
  if (!room || (room->through_asker && !asker.heard && task_)) return false;
  const double drive_s = length(room->path, map_.states().geometry().resolution) / spec_.speed;
  making_room_for_ = asker.robot;
  room_is_for_silent_ = !asker.heard;
  making_room_until_s_ = now_s + kRoomTimeout + (room_is_for_silent_ ? 2.0 : 1.0) * drive_s;
  if (asker.heard) priority_ = room->through_asker ? asker.priority - 1 : asker.priority;
  asks_ = room->ask;
  sink_(now_s, PhaseEvent{self_, "making room"});
  drive(room->path);
  return true;
}

/// Goes on with what was to be done once the other has passed, or time is up.
void Explorer::keep_making_room(std::span<const decision::Neighbour> around, double now_s) {
  const auto asker = std::find_if(around.begin(), around.end(),
                                  [&](const auto& n) { return n.robot == *making_room_for_; });
  const bool still_asks = room_is_for_silent_ || (asker != around.end() &&
                                                  (asker->asks == self_ || (!asker->way.empty() && !arrived_)));
  if (still_asks && now_s < making_room_until_s_) return;
  making_room_for_.reset();
  asks_.reset();
  priority_ = base_priority();
  blocked_since_s_ = -1.0;
  status_news_ = true;
  if (task_ && !plan(task_->stand)) {
    end_task("no way", now_s);
  } else if (!task_) {
    if (phase_ == Phase::kDone && settings_.return_home && !stranded_) {
      phase_ = Phase::kReturning;
      deadline_s_ = now_s + 2.0 * patience();
    }
    if (phase_ == Phase::kReturning) arrived_ = true;  // go_home() plans again
    else stop();
  }
}

/// Makes room for a team-mate that asks for it and goes first.
void Explorer::give_way(double now_s) {
  const auto around = neighbours(now_s);
  if (making_room_for_) return keep_making_room(around, now_s);
  for (const auto& n : around)
    if (n.asks == self_ && n.priority < priority_ && make_room(n, around, now_s)) return;
  step_aside(around, now_s);
}

/// A silent robot has been touching us for a while and we have nowhere to go: it may want to pass.
void Explorer::step_aside(std::span<const decision::Neighbour> around, double now_s) {
  const auto touches = [&](const decision::Neighbour& n) {
    return !n.heard && distance(n.position, pose_.position()) < spec_.radius + n.radius + kTouching;
  };
  const auto mate = std::find_if(around.begin(), around.end(), touches);
  const bool idle = !task_ && phase_ == Phase::kDone;
  if (!idle) stood_aside_ = 0;
  if (!idle || mate == around.end()) {
    touched_since_s_ = now_s;
    return;
  }
  if (now_s < touched_since_s_ + kStuck || stood_aside_ >= kMostAside) return;
  touched_since_s_ = now_s;
  ++stood_aside_;
  decision::Neighbour guess = *mate;
  guess.way = straight_on(mate->position);
  make_room(guess, around, now_s);
}

/// The cells from here on, away from somebody at `from`, up to a wall.
std::vector<Cell> Explorer::straight_on(Point from) const {
  const auto& g = map_.states().geometry();
  const Point at = pose_.position();
  const double apart = distance(from, at);
  std::vector<Cell> cells;
  for (double d = 0.0; d < kStraightOn; d += g.resolution) {
    const Cell c = g.cell_of({at.x + (at.x - from.x) / apart * d, at.y + (at.y - from.y) / apart * d});
    if (!g.contains(c) || map_.states()[c] == CellState::kOccupied) break;
    if (cells.empty() || cells.back() != c) cells.push_back(c);
  }
  return cells;
}

/// Face to face with somebody who cannot be talked to: back along the own trail, out of the way that the other seems to
/// want. The robot with the higher number tries first; the other follows when that does not help.
void Explorer::retreat_from(const decision::Neighbour& silent, std::span<const decision::Neighbour> around, double now_s) {
  if (now_s < blocked_since_s_ + kStuck + (self_ < silent.robot ? kRoomTimeout : 0.0)) return;
  if (retreats_ >= kMostRetreats) return;  // it may be dead
  ++retreats_;
  decision::Neighbour guess = silent;
  guess.way.assign(trail_.rbegin(), trail_.rend());
  make_room(guess, around, now_s);
}

/// What the joint policy tells us to do about somebody; kGo when it does not apply.
decision::LocalAction Explorer::local_action(const decision::Neighbour& mate) const {
  using decision::LocalAction;
  const Point at = pose_.position();
  const double apart = distance(at, mate.position), touching = spec_.radius + mate.radius;
  if (!mate.heard || mate.way.empty() || apart >= settings_.local.close + (held_ ? kGoAgain : 0.0)) return LocalAction::kGo;
  const auto& g = map_.states().geometry();
  const auto heading = [&](const std::vector<Cell>& way, Point from) {
    const auto ahead = std::min(way.size() - 1, static_cast<std::size_t>(std::ceil(kLookAhead / g.resolution)));
    const Point to = g.center(way[ahead]);
    return Point{to.x - from.x, to.y - from.y};
  };
  const auto how = decision::encounter(at, heading(way_, at), mate.position, heading(mate.way, mate.position));
  const bool emergency = apart < std::max(settings_.local.emergency, touching);
  const bool first = std::pair(priority_, self_) < std::pair(mate.priority, mate.robot);
  return local_.action(how, emergency, first);
}

/// Matignon 2012, local coordination: with close team-mates that can be talked to, the joint policy says who goes, who
/// waits and who backtracks. Waiting ends by itself, so that no circle of robots waits for ever.
void Explorer::coordinate_locally(double now_s) {
  using decision::LocalAction;
  LocalAction action = LocalAction::kGo;
  if (!way_.empty() && !making_room_for_ && (held_ || !arrived_) && now_s >= no_wait_until_s_) {
    const auto around = neighbours(now_s);
    for (const auto& mate : around) {
      const LocalAction wanted = local_action(mate);
      if (wanted == LocalAction::kBack && make_room(mate, around, now_s)) return;
      if (wanted != LocalAction::kGo) action = LocalAction::kWait;
    }
  }
  if (action == LocalAction::kGo) {
    if (held_) {
      trim_way();
      drive(std::move(way_));
    }
  } else if (!held_) {
    held_ = true;
    if (now_s >= wait_until_s_) wait_until_s_ = now_s + kMostWait;
    body_.follow({});
  } else if (now_s >= wait_until_s_) {
    no_wait_until_s_ = now_s + kNoWait;
  }
}

/// Somebody else may get through to the task, or this robot later; after some attempts it is given up.
void Explorer::give_back(const char* how, double now_s) {
  if (++blocked_tries_[map_.states().geometry().index(task_->cell)] >= kMostBlocked)
    board_.give_up(task_->cell, false, settings_.grain.spacing);
  else
    board_.defer(task_->cell, settings_.grain.spacing, now_s + kDeferred);
  end_task(how, now_s);
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
    if (task_) give_back("blocked", now_s);
    stop();
    return;
  }
  const auto around = neighbours(now_s);
  const double resolution = map_.states().geometry().resolution;
  const bool stuck = now_s > blocked_since_s_ + kStuck;  // a detour did not help
  const std::size_t rejoin = std::min(way_.size(), static_cast<std::size_t>(kRejoin / resolution) + 1);
  const auto rest = way_.begin() + static_cast<std::ptrdiff_t>(rejoin);
  const double longest = 2.0 * length({way_.begin(), rest}, resolution) + kWorthDetour;
  if (auto way = stuck ? std::nullopt : traffic_.detour(passable_.mask(), base(), way_[rejoin - 1], longest, around);
      way && length(*way, resolution) <= longest) {
    way->insert(way->end(), rest, way_.end());
    if (!making_room_for_) asks_.reset();
    drive(std::move(*way));
    return;
  }
  const auto* first = traffic_.in_the_way(way_, around, kNearby);
  if (first != nullptr && !first->heard && !making_room_for_) return retreat_from(*first, around, now_s);
  if (first != nullptr && asks_ != first->robot) {
    asks_ = first->robot;
    status_news_ = true;
  }
}

}  // namespace outrider::explorer
