// What Explorer does about team-mates in its way: local coordination, right of way, making room.

#include <algorithm>
#include <cmath>
#include <utility>

#include "explorer/explorer.hpp"

namespace outrider::explorer {
namespace {

constexpr double kPatience = 0.3;        // [s] blocked before anything is done about it
constexpr double kStuck = 3.0;           // [s] blocked before detours are given up and room is asked for
constexpr double kTryAgain = 0.5;        // [s] between attempts
constexpr double kGiveUp = 15.0;         // [s] blocked before the task is given back
constexpr double kDeferred = 20.0;       // [s] until a task that was blocked is tried again
constexpr int kTieBreak = 4;             // every so many attempts to let the silent pass are left to chance
constexpr double kMoved = 0.01;          // [m] somebody who moved farther than this is alive
constexpr double kStroll = 3.0;          // [m] the first time; farther every time after that
constexpr int kMostBlocked = 3;          // times that a task is given back before it is given up
constexpr double kRoomTimeout = 8.0;     // [s] that room is made for somebody, beside the way there
constexpr double kMostWait = 6.0;        // [s] that a close team-mate is waited for
constexpr double kNoWait = 10.0;         // [s] after that in which nobody is waited for
constexpr double kGoAgain = 0.2;         // [m] farther away than close, who was waited for counts as gone
constexpr double kLookAhead = 0.5;       // [m] on the way to where a robot is heading
constexpr double kWorthDetour = 4.0;     // [m] a detour may always cost this much
constexpr double kRejoin = 20.0;         // [m] a detour comes back to the way after no more than this of it
constexpr double kNearby = 10.0;         // [m] team-mates farther away do not matter
constexpr double kTouching = 0.01;       // [m] between bodies
constexpr double kStraightOn = 5.0;      // [m]
constexpr int kMostAside = 16;           // times that a robot with nothing to do steps aside for the silent
constexpr int kIdlePriority = 1000;      // robots without a task make room for those that have one

double length(const std::vector<Cell>& way, double resolution) {
  double cells = 0.0;
  for (std::size_t k = 1; k < way.size(); ++k) cells += std::hypot(way[k].x - way[k - 1].x, way[k].y - way[k - 1].y);
  return cells * resolution;
}

}  // namespace

/// Lower goes first. Who makes room for somebody goes as that one would.
int Explorer::priority() const {
  if (lent_priority_) return *lent_priority_;
  return task_ || phase_ == Phase::kReturning ? self_ : kIdlePriority + self_;
}

/// Team-mates in view. What they said counts as long as they are heard; of the silent only the place is known, and
/// everybody goes first whose number is lower.
std::vector<decision::Neighbour> Explorer::neighbours(double now_s) const {
  std::vector<decision::Neighbour> result;
  for (const Sighting& sighting : sightings_) {
    if (distance(sighting.position, pose_.position()) > kNearby) continue;
    decision::Neighbour n{sighting.robot, sighting.position, sighting.radius, {}, sighting.robot, {}};
    if (const Teammate* mate = find_mate(team_, n.robot); mate != nullptr && in_hearing(*mate, now_s)) {
      n.way = mate->status.way;
      n.priority = mate->status.priority;
      n.asks = mate->status.asks;
      n.heard = true;
      n.stays = mate->status.done && n.priority == n.robot;  // on its way home, not out of somebody's way
    }
    result.push_back(std::move(n));
  }
  return result;
}

/// Drives to where `asker` can pass; false when there is no such place.
bool Explorer::make_room(const decision::Neighbour& asker, std::span<const decision::Neighbour> around, double now_s) {
  const auto room = traffic_.make_room(passable_.mask(), base(), asker, around, destination());
  if (!room || (room->through_asker && !asker.heard && task_)) return false;
  const double resolution = map_.states().geometry().resolution;
  const double told_m = asker.heard ? length(asker.way, resolution) : 0.0;
  const double drive_s = (length(room->path, resolution) + told_m) / spec_.speed;
  making_room_for_ = asker.robot;
  room_is_for_silent_ = !asker.heard;
  making_room_until_s_ = now_s + (task_ || !asker.heard ? 1.0 : 3.0) * kRoomTimeout +
                         (room_is_for_silent_ || room->through_asker ? 2.0 : 1.0) * drive_s;
  lent_priority_.reset();
  if (asker.heard) lent_priority_ = room->through_asker ? asker.priority - 1 : asker.priority;
  asks_ = room->ask;
  sink_(now_s, PhaseEvent{self_, "making room"});
  drive(room->path);
  return true;
}

/// Where this robot wants to be in the end: at its task, or at home.
std::optional<Cell> Explorer::destination() const {
  if (task_) return task_->stand;
  if (settings_.return_home) return map_.states().geometry().cell_of(spec_.start.position());
  return std::nullopt;
}

/// The straight way on would run into somebody who is still on its own.
bool Explorer::would_meet(const Teammate& mate) {
  const auto goal = destination();
  if (!goal) return false;
  const decision::Neighbour there[] = {{mate.robot, mate.status.pose.position(), mate.status.radius, {}, 0, {}}};
  const std::vector<Cell> path = board_.path_to(base(), *goal);
  if (traffic_.in_the_way(path, there, kNearby) != nullptr) return true;
  const auto& g = map_.states().geometry();
  return std::any_of(mate.status.way.begin(), mate.status.way.end(), [&](Cell c) {
    const decision::Neighbour then[] = {{mate.robot, g.center(c), mate.status.radius, {}, 0, {}}};
    return traffic_.in_the_way(path, then, kNearby) != nullptr;
  });
}

/// The other has not passed yet. Who has nothing to explore also waits until both ways are clear of each other.
bool Explorer::room_is_needed(double now_s) {
  if (now_s >= making_room_until_s_) return false;
  if (room_is_for_silent_) return true;
  const Teammate* asker = find_mate(team_, *making_room_for_);
  if (asker == nullptr || !in_hearing(*asker, now_s)) return false;
  if (asker->status.asks == self_ || (!asker->status.way.empty() && !arrived_)) return true;
  if (task_ || asker->status.way.size() < 2) return false;
  if (now_s < last_try_s_ + kTryAgain) return true;
  last_try_s_ = now_s;
  return would_meet(*asker);
}

/// Goes on with what was to be done once the other has passed, or time is up.
void Explorer::keep_making_room(double now_s) {
  if (room_is_needed(now_s)) {
    if (arrived_ && asks_) asks_.reset(), status_news_ = true;
    return;
  }
  making_room_for_.reset();
  lent_priority_.reset();
  asks_.reset();
  blocked_since_s_ = -1.0;
  status_news_ = true;
  if (task_ && !plan(task_->stand)) {
    end_task("no way", now_s);
  } else if (!task_) {
    if (phase_ == Phase::kDone && settings_.return_home && !stranded_) phase_ = Phase::kReturning;
    if (phase_ == Phase::kReturning) arrived_ = true;  // go_home() plans again
    else stop();
  }
}

/// Makes room for a team-mate that asks for it and goes first.
void Explorer::give_way(double now_s) {
  const auto around = neighbours(now_s);
  if (making_room_for_) return keep_making_room(now_s);
  for (const auto& n : around)
    if (n.asks == self_ && n.priority < priority() && make_room(n, around, now_s)) return;
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
  if (++stood_aside_ % kTieBreak == 0) return stroll(*mate, around, now_s);
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
  if (!has_moved(silent)) return;  // it may be dead
  if (++retreats_ % kTieBreak == 0) return stroll(silent, around, now_s);
  decision::Neighbour guess = silent;
  guess.way.assign(trail_.rbegin(), trail_.rend());
  make_room(guess, around, now_s);
}

/// Since it was last in the way, or it never was.
bool Explorer::has_moved(const decision::Neighbour& mate) {
  const auto [before, first] = blocked_at_.try_emplace(mate.robot, mate.position);
  return first || distance(std::exchange(before->second, mate.position), mate.position) > kMoved;
}

/// Leaves the scene for a while, no matter where to: whoever cannot sort it out with `mate` has to break the tie.
void Explorer::stroll(const decision::Neighbour& mate, std::span<const decision::Neighbour> around, double now_s) {
  const double reach = kStroll * (1 + retreats_ + stood_aside_);
  std::vector<Cell> path = traffic_.stroll(passable_.mask(), base(), around, reach, luck_());
  const double drive_s = length(path, map_.states().geometry().resolution) / spec_.speed;
  making_room_for_ = mate.robot;
  room_is_for_silent_ = true;
  making_room_until_s_ = now_s + 2.0 * drive_s + static_cast<double>(luck_() % 16);
  lent_priority_.reset();
  asks_.reset();
  sink_(now_s, PhaseEvent{self_, "making room"});
  drive(std::move(path));
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
  const bool first = std::pair(priority(), self_) < std::pair(mate.priority, mate.robot);
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

/// Somebody else may get through to the task, or this robot later; in the end it is given up, unless whoever blocks the
/// way moves in between.
void Explorer::give_back(const char* how, double now_s) {
  const auto around = neighbours(now_s);
  const auto* blocker = traffic_.in_the_way(way_, around, kNearby);
  int& tries = blocked_tries_[map_.states().geometry().index(task_->cell)];
  if (blocker == nullptr || !has_moved(*blocker)) ++tries;
  if (tries >= kMostBlocked) board_.give_up_around(task_->cell, settings_.grain.spacing);
  else board_.defer(task_->cell, settings_.grain.spacing, now_s + kDeferred);
  end_task(how, now_s);
  stop();
  if (blocker != nullptr) stroll(*blocker, around, now_s);
}

/// Stays where it is: a dead team-mate may lie in the only way home.
void Explorer::strand(double now_s) {
  phase_ = Phase::kDone;
  stranded_ = true;
  if (!making_room_for_) stop();
  sink_(now_s, PhaseEvent{self_, "stranded"});
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
  const auto around = neighbours(now_s);
  const auto* first = traffic_.in_the_way(way_, around, kNearby);
  if (now_s > blocked_since_s_ + kGiveUp && !making_room_for_) {
    blocked_since_s_ = -1.0;
    asks_.reset();
    if (task_) return give_back("blocked", now_s);
    stop();
    if (first != nullptr) stroll(*first, around, now_s);
    return;
  }
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
  if (first != nullptr && !first->heard && !making_room_for_) return retreat_from(*first, around, now_s);
  if (first != nullptr && asks_ != first->robot) {
    asks_ = first->robot;
    status_news_ = true;
  }
}

}  // namespace outrider::explorer
