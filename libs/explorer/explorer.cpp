#include "explorer/explorer.hpp"

#include <algorithm>
#include <cmath>

namespace outrider::explorer {
namespace {

constexpr double kLookAround = 0.3;    // [s] at the stand before a task counts as not observable
constexpr double kLookAgain = 0.5;     // [s] between questions whether a task is still worth its way
constexpr double kAskAgain = 2.0;      // [s] between questions to a coordinator that had nothing for us

}  // namespace

Explorer::Explorer(RobotId self, RobotSpec spec, const GridGeometry& geometry, const ExplorerSettings& settings,
                   Body& body, link::Bus& bus, std::unique_ptr<ScanMapper> mapper,
                   std::unique_ptr<Coordinator> coordinator, EventSink sink)
    : self_(self),
      spec_(std::move(spec)),
      settings_(settings),
      body_(body),
      bus_(bus),
      mapper_(std::move(mapper)),
      coordinator_(std::move(coordinator)),
      sink_(std::move(sink)),
      map_(geometry),
      exchange_(self, map_, {.silent_after = settings.silent_after}),
      seen_(geometry),
      passable_(geometry, spec_.radius),
      traffic_(geometry, spec_.radius),
      board_(spec_, map_.states()),
      pose_(spec_.start),
      luck_(static_cast<std::uint32_t>(self) + 1) {}

void Explorer::sense(double now_s) {
  const Sensing& sensing = body_.sense();
  pose_ = sensing.pose;
  arrived_ = sensing.arrived;
  blocked_ = sensing.blocked;
  note_trail();
  sightings_ = sensing.sightings;
  for (const Sighting& seen : sightings_)  // whoever is in view is known to be there, heard or not
    if (Teammate* mate = find_mate(team_, seen.robot))
      mate->status.pose = {seen.position.x, seen.position.y, mate->status.pose.theta};
  take_in(sensing);
  note_news(now_s);
  share();
}

/// Whatever keeps track of the map hears what changed in it.
void Explorer::note_news(double now_s) {
  const std::vector<std::uint32_t> news = map_.take_changed();
  if (news.empty()) return;
  const auto mask_news = passable_.update(map_.states(), news);
  board_.note_changes(news, passable_, mask_news);
  changed_.insert(changed_.end(), news.begin(), news.end());
  map_news_s_ = now_s;
}

void Explorer::take_in(const Sensing& sensing) {
  observed_.clear();
  const auto see = [&](std::uint32_t index, CellState state) {
    if (!seen_[index]) {
      seen_.insert(index);
      observed_.push_back(index);
      if (map_.states()[index] == CellState::kUnknown) new_area_ += map_.states().geometry().cell_area();
    }
    map_.observe(index, state);
  };
  for (const SeenCell& cell : sensing.cells) see(cell.index, cell.state);
  std::vector<std::uint32_t> changed;
  for (const PosedScan& scan : sensing.scans) mapper_->insert(scan, changed);
  for (const std::uint32_t index : changed)
    if (mapper_->states()[index] != CellState::kUnknown) see(index, mapper_->states()[index]);
}

void Explorer::share() {
  const auto runs = map_.take_to_share();
  for (std::size_t k = 0; k < runs.size(); k += MapUpdate::kMostRuns) {
    const auto begin = runs.begin() + static_cast<std::ptrdiff_t>(k);
    const auto end = runs.begin() + static_cast<std::ptrdiff_t>(std::min(runs.size(), k + MapUpdate::kMostRuns));
    bus_.send(MapUpdate{self_, ++seq_, {begin, end}});
  }
}

void Explorer::send_status(double now_s) {
  StatusMessage status{.robot = self_, .seq = ++seq_, .pose = pose_};
  if (task_) status.goal = task_->cell;
  trim_way();
  status.way.assign(way_.begin(), way_.begin() + static_cast<std::ptrdiff_t>(std::min(way_.size(), StatusMessage::kMaxWay)));
  status.speed = spec_.speed;
  status.range = spec_.range;
  status.radius = spec_.radius;
  status.explored_rate = rate_.value();
  status.done = phase_ != Phase::kExploring;
  status.priority = priority();
  status.asks = asks_;
  status.map_hash = map_.hash();
  status.epoch = epoch_;
  for (const Teammate& mate : team_)
    if (in_hearing(mate, now_s) && status.heard.size() < StatusMessage::kMostHeard)
      status.heard.push_back(mate.robot);
  bus_.send(std::move(status));
  status_news_ = false;
  status_due_s_ = now_s + settings_.status_period;
}

bool Explorer::listen(double now_s) {
  const auto mail = bus_.receive();
  for (const auto& delivery : mail) hear(delivery, now_s);
  note_news(now_s);
  if (!inbox_.empty()) run_coordinator(now_s);
  return !mail.empty();
}

void Explorer::hear(const link::Delivery& delivery, double now_s) {
  const Message& message = *delivery.message;
  exchange_.hear(message, now_s);
  if (const auto* update = std::get_if<MapUpdate>(&message)) {
    for (const CellRun& run : update->runs) map_.merge(run);
  } else if (const auto* status = std::get_if<StatusMessage>(&message)) {
    Teammate* mate = find_mate(team_, status->robot);
    if (mate == nullptr) {
      const auto after = std::find_if(team_.begin(), team_.end(), [&](const Teammate& t) { return t.robot > status->robot; });
      mate = &*team_.insert(after, Teammate{status->robot, {}, 0.0});
    }
    mate->status = *status;  // in place: its way keeps its memory
    mate->heard_s = now_s;
  } else if (is_auction_traffic(message)) {
    inbox_.push_back(delivery);
  }
}

void Explorer::act(double now_s) {
  if (phase_ == Phase::kExploring) {
    check_task(now_s);
    run_coordinator(now_s);
  } else if (phase_ == Phase::kReturning) {
    go_home(now_s);
  } else if (map_news_s_ >= now_s) {  // a team-mate may have opened up new ground for us
    phase_ = Phase::kExploring;
  }
  give_way(now_s);
  resolve_block(now_s);
  coordinate_locally(now_s);
  if (status_news_ || now_s >= status_due_s_) send_status(now_s);
  for (Message& message : exchange_.speak(now_s)) bus_.send(std::move(message));
  settled_ = exchange_.settled(now_s);
  changed_.clear();
}

void Explorer::check_task(double now_s) {
  if (!task_) return;
  // It lives while its block of frontier does: robots sense on the way, and the very cell is soon behind the front.
  if (!changed_.empty() && !board_.frontier_near(task_->cell, settings_.grain.spacing))
    return end_task(arrived_ ? "reached" : "seen from afar", now_s);
  if (!changed_.empty() && !way_is_passable() && !making_room_for_ && !plan(task_->stand))
    return end_task("no way", now_s);
  if (!changed_.empty() && now_s >= look_at_s_) {
    look_at_s_ = now_s + kLookAgain;
    if (!board_.is_worth_it(task_->stand)) return end_task("too little left", now_s);
  }
  if (now_s > deadline_s_) {  // driven off its way again and again: whatever the reason, never for ever
    return give_back("out of time", now_s);
  }
  if (!has_reached(task_->stand) || making_room_for_) {
    arrived_s_ = now_s;
  } else if (now_s > arrived_s_ + kLookAround) {
    board_.give_up_from(passable_, task_->stand);
    end_task("not observable", now_s);
  }
}

/// What a task or the way home may take: several times the way, and time for some encounters [s].
double Explorer::patience() const {
  const double metres = static_cast<double>(way_.size()) * map_.states().geometry().resolution;
  return 60.0 + 5.0 * metres / spec_.speed;
}

void Explorer::end_task(const char* how, double now_s) {
  sink_(now_s, TaskEndEvent{self_, task_->cell, how});
  task_.reset();
  refused_s_ = -1e9;
  status_news_ = true;
}

/// The team-mates in hearing: usually all that were ever heard, and nothing has to be copied.
std::span<const Teammate> Explorer::heard_of_late(double now_s) {
  const auto silent = [&](const Teammate& mate) { return !in_hearing(mate, now_s); };
  if (std::none_of(team_.begin(), team_.end(), silent)) return team_;
  std::size_t heard = 0;  // copied over last time's, whose memory is used again
  for (const Teammate& mate : team_) {
    if (silent(mate)) continue;
    if (heard < heard_.size()) heard_[heard] = mate;
    else heard_.push_back(mate);
    ++heard;
  }
  heard_.resize(heard);
  return heard_;
}

void Explorer::run_coordinator(double now_s) {
  const std::span<const Teammate> in_hearing = heard_of_late(now_s);
  if (now_s > period_begin_s_ && (!inbox_.empty() || !task_)) {  // an auction period ends: eq. 6 to 9
    rate_.add(new_area_, now_s - period_begin_s_);
    new_area_ = 0.0;
    period_begin_s_ = now_s;
  }
  const std::function<std::vector<BidEntry>(const TaskGrain&)> tasks = [this](const TaskGrain& grain) {
    return board_.entries(passable_, base(), grain);
  };
  const bool waits = board_.any_deferred(now_s);
  const bool needs_task = !task_ && phase_ == Phase::kExploring &&
                          (map_news_s_ > refused_s_ || now_s >= refused_s_ + kAskAgain);
  const Situation situation{now_s, self_, spec_, pose_, map_.states(), passable_, here(), in_hearing, team_,
                            task_, needs_task, rate_.value(), inbox_, tasks};
  Decision decision = coordinator_->decide(situation);
  inbox_.clear();
  for (Message& message : decision.send) bus_.send(std::move(message));
  for (const AuctionRecord& record : decision.records) sink_(now_s, record);
  if (waits && decision.verdict == Decision::Verdict::kNothing) decision.verdict = Decision::Verdict::kIdle;
  apply(decision, now_s);
}

void Explorer::apply(const Decision& decision, double now_s) {
  using Verdict = Decision::Verdict;
  epoch_ = decision.epoch.value_or(epoch_);
  if (decision.verdict == Verdict::kGo) {
    phase_ = Phase::kExploring;
    if (task_ == decision.task) return;
    if (!plan(decision.task->stand)) {
      refused_s_ = now_s;
      return;
    }
    task_ = decision.task;
    retreats_ = 0;
    arrived_s_ = now_s;
    deadline_s_ = now_s + patience();
    making_room_for_.reset();
    lent_priority_.reset();
    status_news_ = true;
    sink_(now_s, GoalEvent{self_, *task_, static_cast<double>(way_.size()) * map_.states().geometry().resolution,
                           decision.value});
  } else if (decision.verdict == Verdict::kIdle) {
    refused_s_ = now_s;
    if (task_) {
      end_task("reassigned", now_s);
      refused_s_ = now_s;
      stop();
    }
  } else if (decision.verdict == Verdict::kNothing && phase_ == Phase::kExploring) {
    nothing_left(now_s);
  }
}

void Explorer::nothing_left(double now_s) {
  refused_s_ = now_s;
  phase_ = Phase::kDone;
  const Cell home = map_.states().geometry().cell_of(spec_.start.position());
  if (settings_.return_home && here() != home) phase_ = Phase::kReturning;
  sink_(now_s, PhaseEvent{self_, phase_ == Phase::kDone ? "done" : "returning"});
  if (!making_room_for_) stop();
  if (phase_ == Phase::kReturning && !making_room_for_) plan(home);
  deadline_s_ = now_s + 4.0 * patience();
  retreats_ = 0;
  status_news_ = true;
}

void Explorer::go_home(double now_s) {
  const Cell home = map_.states().geometry().cell_of(spec_.start.position());
  if (has_reached(home)) {
    phase_ = map_news_s_ > refused_s_ ? Phase::kExploring : Phase::kDone;  // there may be something left after all
    sink_(now_s, PhaseEvent{self_, "home"});
  } else if (now_s > deadline_s_) {
    strand(now_s);
  } else if (arrived_ && !making_room_for_ && !held_) {
    plan(home);
  }
}

void Explorer::restart(double now_s) {
  task_.reset();
  way_.clear();
  stranded_ = false;
  phase_ = Phase::kExploring;
  asks_.reset();
  making_room_for_.reset();
  lent_priority_.reset();
  blocked_since_s_ = -1.0;
  refused_s_ = -1e9;
  period_begin_s_ = now_s;
  status_news_ = true;
}

}  // namespace outrider::explorer
