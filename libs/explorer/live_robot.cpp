#include "explorer/live_robot.hpp"

#include <algorithm>
#include <cmath>

namespace outrider::explorer {
namespace {

constexpr double kIntroduceAgain = 5.0;  // [s]
constexpr int kMostSteps = 10;           // that a body catches up with after a stall

class LiveRobot {
 public:
  LiveRobot(const LiveSettings& settings, LiveBody body, link::Bus& bus, const LiveClock& clock, const EventSink& events)
      : settings_(settings),
        body_(std::move(body)),
        bus_(bus),
        clock_(clock),
        robot_(settings.self, spec(), settings.geometry, settings.explorer, *body_.body, bus,
               settings.make_mapper ? settings.make_mapper(settings.geometry, spec()) : nullptr,
               make_coordinator(settings.coordinator, settings.coordination), events) {}

  LiveFarewell run(const std::atomic<bool>& interrupted, const LineSink& journal) {
    farewell_.end = LiveEnd::kInterrupted;
    begin_s_ = together_since_s_ = clock_.now_s();
    auto tick = static_cast<std::int64_t>(std::floor(begin_s_ / settings_.period_s));
    while (!interrupted) {
      const double now_s = clock_.now_s();
      const auto due = static_cast<std::int64_t>(std::floor(now_s / settings_.period_s));
      for (std::int64_t k = std::max(tick, due - kMostSteps); k < due; ++k) body_.step();
      tick = due;
      act(now_s);
      journal(entry_line(now_s, robot_.pose(), robot_.observed()));
      if (over(now_s)) break;
      listen_until(static_cast<double>(tick + 1) * settings_.period_s, interrupted);
    }
    return conclude();
  }

 private:
  const RobotSpec& spec() const { return settings_.team[static_cast<std::size_t>(settings_.self)]; }

  void act(double now_s) {
    if (now_s >= introduce_s_) {
      bus_.send(Introduction{settings_.self, spec(), settings_.geometry, settings_.coordinator,
                             static_cast<int>(settings_.team.size()), settings_.time_scale});
      introduce_s_ = now_s + kIntroduceAgain;
    }
    robot_.sense(now_s);
    robot_.listen(now_s);
    robot_.act(now_s);
    if (robot_.exploring()) farewell_.done_s = now_s;
  }

  void listen_until(double end_s, const std::atomic<bool>& interrupted) {
    while (!interrupted) {
      if (clock_.wait_for_mail(end_s)) robot_.listen(clock_.now_s());
      if (clock_.now_s() >= end_s) return;
    }
  }

  /// Sets the reason when it is time to leave.
  bool over(double now_s) {
    if (settings_.most_s > 0.0 && now_s >= settings_.most_s) {
      farewell_.end = LiveEnd::kTimeout;
      return true;
    }
    if (!team_is_done(now_s)) together_since_s_ = now_s;
    if (now_s < together_since_s_ + settings_.linger_s) return false;
    farewell_.end = LiveEnd::kTeamDone;
    return true;
  }

  bool team_is_done(double now_s) {
    bool done = robot_.done();
    for (RobotId id = 0; id < static_cast<RobotId>(settings_.team.size()); ++id) {
      if (id == settings_.self) continue;
      const Teammate* mate = find_mate(robot_.team(), id);
      const bool known = mate != nullptr;
      const double heard_s = known ? mate->heard_s : begin_s_;
      const bool gone = now_s > heard_s + settings_.silent_is_gone_s;
      const bool equal = known && mate->status.map_hash == robot_.map_hash();
      if (known && !gone && !equal) farewell_.equal_s = now_s;
      done = done && (gone || (equal && mate->status.done));
    }
    return done;
  }

  LiveFarewell conclude() {
    farewell_.t = clock_.now_s();
    farewell_.path_m = body_.path_m();
    farewell_.map_hash = robot_.map_hash();
    farewell_.map = robot_.map();
    farewell_.left = robot_.left(robot_.map());
    return std::move(farewell_);
  }

  const LiveSettings& settings_;
  LiveBody body_;
  link::Bus& bus_;
  const LiveClock& clock_;
  Explorer robot_;
  LiveFarewell farewell_;
  double begin_s_ = 0.0, introduce_s_ = -1e9;
  double together_since_s_ = 0.0;  // everybody has been done since
};

}  // namespace

LiveFarewell run_live(const LiveSettings& settings, LiveBody body, link::Bus& bus, const LiveClock& clock,
                      const std::atomic<bool>& interrupted, const LineSink& journal, const EventSink& events) {
  return LiveRobot(settings, std::move(body), bus, clock, events).run(interrupted, journal);
}

}  // namespace outrider::explorer
