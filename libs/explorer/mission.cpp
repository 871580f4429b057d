#include "explorer/mission.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "explorer/referee.hpp"

namespace outrider::explorer {
namespace {

constexpr int kMostMailRounds = 64;  // of messages answering messages within one step

/// Localisation errors of one robot so far.
struct ErrorSums {
  double squares = 0.0, max = 0.0, last = 0.0, count = 0.0;
  void note(double error_m) {
    squares += error_m * error_m;
    max = std::max(max, error_m);
    last = error_m;
    count += 1.0;
  }
  LocalizationError summary() const { return {count > 0.0 ? std::sqrt(squares / count) : 0.0, max, last}; }
};

/// The running mission: owns world, radio and minds; one step after the other.
class Mission {
 public:
  Mission(const OccupancyGrid& truth, const std::vector<RobotSpec>& team, const MissionSettings& settings)
      : settings_(settings),
        simulator_(truth, team, settings.sim),
        referee_(truth, team),
        radio_(settings.radio, referee_.expected_s(), truth,
               [this](RobotId robot) { return simulator_.pose(robot).position(); }),
        ether_(static_cast<int>(team.size()),
               [this](RobotId from, RobotId to, double now_s) { return radio_(from, to, now_s); }) {
    const EventSink sink = [this](double t, const Event& event) {
      if (settings_.record_events) result_.events.push_back({t, event});
    };
    for (std::size_t r = 0; r < team.size(); ++r) {
      const auto id = static_cast<RobotId>(r);
      robots_.push_back(std::make_unique<Explorer>(
          id, team[r], truth.geometry(), settings.explorer, body_of(id), ether_.endpoint(id),
          settings.sim.lidar ? settings.make_mapper(truth.geometry(), team[r]) : nullptr,
          make_coordinator(settings.coordinator, settings.coordination), sink));
    }
  }

  /// The simulator's body, or what stands between it and a mind that has to localise itself.
  Body& body_of(RobotId id) {
    if (settings_.localization == Localization::kPerfect) return simulator_.body(id);
    const std::uint64_t stream = settings_.sim.seed * 1'000'003 + static_cast<std::uint64_t>(id);
    const RobotSpec& spec = simulator_.team()[static_cast<std::size_t>(id)];
    PoseTracking tracking;
    if (settings_.localization == Localization::kSlam) tracking = settings_.make_tracking(spec);
    localized_.push_back(std::make_unique<LocalizedBody>(simulator_.body(id), spec, std::move(tracking), settings_.odometry, stream));
    errors_.emplace_back();
    return *localized_.back();
  }

  MissionResult run(const MissionProgress& progress) {
    const double most_s = settings_.max_time_s > 0.0 ? settings_.max_time_s : referee_.patience_s();
    for (std::uint64_t step = 0;; ++step) {
      if (step > 0) simulator_.step();
      now_s_ = static_cast<double>(step) * settings_.sim.dt;
      inject_faults();
      announce_breaks();
      tick();
      if (finished()) break;
      if (now_s_ >= most_s) {
        result_.status = MissionStatus::kTimeout;
        break;
      }
      if (progress && step % 64 == 0 && !progress(now_s_, referee_.explored_fraction())) {
        result_.status = MissionStatus::kInterrupted;
        break;
      }
    }
    return conclude();
  }

 private:
  bool alive(RobotId robot) const { return simulator_.alive(robot); }

  void tick() {
    ether_.set_time(now_s_);
    for_living([&](Explorer& robot, RobotId id) {
      robot.sense(now_s_);
      referee_.saw(id, robot.observed(), now_s_);
    });
    exchange();
    for_living([&](Explorer& robot, RobotId) {
      const auto begin = std::chrono::steady_clock::now();
      robot.act(now_s_);
      const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
      if (took.count() > 0.02) result_.decision_ms.push_back(took.count());
    });
    exchange();
    for (RobotId id = 0; id < static_cast<RobotId>(robots_.size()); ++id)
      referee_.stands(id, {now_s_, simulator_.pose(id)});
    for (std::size_t r = 0; r < localized_.size(); ++r)
      errors_[r].note(distance(localized_[r]->believed().position(), simulator_.pose(static_cast<RobotId>(r)).position()));
    referee_.tick(now_s_);
    count_interactions();
  }

  void count_interactions() {
    constexpr double kClose = 1.0;  // [m]
    const std::size_t n = robots_.size();
    close_.resize(n * n);
    for (std::size_t a = 0; a < n; ++a) {
      bool any = false, any_cut = false;
      for (std::size_t b = 0; b < n; ++b) {
        if (a == b) continue;
        const Point at = simulator_.pose(static_cast<RobotId>(a)).position(),
                    other = simulator_.pose(static_cast<RobotId>(b)).position();
        const bool close = std::abs(at.x - other.x) < kClose && distance(at, other) < kClose;
        const bool cut = close && cut_off(static_cast<RobotId>(a), static_cast<RobotId>(b));
        const bool begins = close && !close_[a * n + b] && a < b;
        result_.interactions += begins;
        result_.interactions_in_breaks += begins && cut;
        close_[a * n + b] = close;
        any = any || close;
        any_cut = any_cut || cut;
      }
      if (any) result_.interaction_s += settings_.sim.dt;
      if (any_cut) result_.interaction_in_breaks_s += settings_.sim.dt;
    }
  }

  /// A break silences the two now.
  bool cut_off(RobotId a, RobotId b) const {
    const auto& breaks = radio_.breaks();
    return std::any_of(breaks.begin(), breaks.end(), [&](const link::Break& cut) { return cut.cuts(a, b, now_s_); });
  }

  /// Messages are answered within the step until the air is quiet.
  void exchange() {
    for (int round = 0; round < kMostMailRounds && ether_.pending(); ++round)
      for_living([&](Explorer& robot, RobotId) { robot.listen(now_s_); });
    for (RobotId id = 0; id < static_cast<RobotId>(robots_.size()); ++id)
      if (!alive(id)) ether_.endpoint(id).receive();  // the dead hear nothing
  }

  template <class Do>
  void for_living(Do&& act) {
    for (RobotId id = 0; id < static_cast<RobotId>(robots_.size()); ++id)
      if (alive(id)) act(*robots_[static_cast<std::size_t>(id)], id);
  }

  void inject_faults() {
    for (; next_fault_ < settings_.faults.size() && settings_.faults[next_fault_].t <= now_s_; ++next_fault_) {
      const Fault& fault = settings_.faults[next_fault_];
      const char* what = "kill";
      switch (fault.kind) {
        case Fault::Kind::kKill: simulator_.kill(fault.robot); break;
        case Fault::Kind::kSlow:
          what = "slow";
          simulator_.set_speed_factor(fault.robot, fault.factor);
          break;
        case Fault::Kind::kRevive:
          what = "revive";
          simulator_.revive(fault.robot);
          robots_[static_cast<std::size_t>(fault.robot)]->restart(now_s_);
          break;
        case Fault::Kind::kDeaf:
        case Fault::Kind::kHear:
          what = fault.kind == Fault::Kind::kDeaf ? "deaf" : "hears again";
          radio_.set_deaf(fault.robot, fault.kind == Fault::Kind::kDeaf);
          break;
      }
      if (settings_.record_events) result_.events.push_back({now_s_, FaultEvent{fault.robot, what}});
    }
  }

  /// Notes the breaks that begin or end with this step.
  void announce_breaks() {
    if (!settings_.record_events) return;
    for (const link::Break& b : radio_.breaks())
      for (const bool begins : {true, false}) {
        const double t = begins ? b.begin_s : b.end_s;
        if (t > now_s_ - settings_.sim.dt && t <= now_s_) result_.events.push_back({now_s_, BreakEvent{b, begins}});
      }
  }

  /// Sets the status when the mission is over.
  bool finished() {
    bool any_alive = false, all_done = true, exploring = false;
    for_living([&](Explorer& robot, RobotId) {
      any_alive = true;
      all_done = all_done && robot.done();
      exploring = exploring || robot.exploring();
    });
    if (!any_alive && next_fault_ == settings_.faults.size()) {
      result_.status = MissionStatus::kFailed;
      return true;
    }
    if (exploring) explored_at_s_ = now_s_;
    const bool aim_reached = settings_.until < 1.0 && referee_.explored_fraction() >= settings_.until;
    if (!all_done && !(aim_reached && !settings_.explorer.return_home)) return false;
    if (any_alive && all_done) exchange();
    result_.status = aim_reached || referee_.explored_fraction() >= Referee::kExplored
                         ? MissionStatus::kExplored : MissionStatus::kUnreachableLeft;
    return any_alive;
  }

  MissionResult conclude() {
    referee_.tick(now_s_);
    result_.time_s = result_.status == MissionStatus::kTimeout ? now_s_ : explored_at_s_;
    result_.mission_time_s = now_s_;
    result_.radio = ether_.counters();
    std::vector<const OccupancyGrid*> maps;
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      maps.push_back(&robots_[r]->map());
      result_.robots.push_back(referee_.robot(static_cast<RobotId>(r)));
      if (!localized_.empty()) result_.robots.back().localization = errors_[r].summary();
      result_.robots.back().path_m = simulator_.path_m(static_cast<RobotId>(r));
    }
    referee_.conclude(maps, result_);
    result_.maps_equal = true;
    std::optional<std::size_t> first;
    for_living([&](Explorer&, RobotId id) {
      const auto r = static_cast<std::size_t>(id);
      if (!first) first = r;
      result_.maps_equal = result_.maps_equal && *maps[*first] == *maps[r];
    });
    result_.left = robots_[first.value_or(0)]->left(result_.map);
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      merge_reasons(robots_[r]->left(result_.map));
      result_.robots[r].map = robots_[r]->map();
      robots_[r].reset();  // one by one, to need less memory
    }
    return std::move(result_);
  }

  /// A frontier that anybody tried in vain is not observable, whatever the first robot thinks of it.
  void merge_reasons(const std::vector<Left>& other) {
    for (std::size_t k = 0; k < std::min(other.size(), result_.left.size()); ++k)
      if (other[k].why == LeftReason::kNotObservable) result_.left[k].why = other[k].why;
  }

  const MissionSettings& settings_;
  sim::Simulator simulator_;
  Referee referee_;
  link::Radio radio_;
  link::Ether ether_;
  std::vector<std::unique_ptr<LocalizedBody>> localized_;  // of every robot, or none
  std::vector<ErrorSums> errors_;                          // of the same robots
  std::vector<std::unique_ptr<Explorer>> robots_;
  MissionResult result_;
  std::vector<char> close_;  // n x n: closer than kClose in the last step
  std::size_t next_fault_ = 0;
  double now_s_ = 0.0;
  double explored_at_s_ = 0.0;  // last time anybody was still exploring
};

}  // namespace

std::string to_string(MissionStatus status) {
  switch (status) {
    case MissionStatus::kExplored: return "explored";
    case MissionStatus::kUnreachableLeft: return "unreachable_left";
    case MissionStatus::kTimeout: return "timeout";
    case MissionStatus::kFailed: return "failed";
    case MissionStatus::kInterrupted: return "interrupted";
  }
  return "";
}

MissionResult run_mission(const OccupancyGrid& truth, const std::vector<RobotSpec>& team,
                          const MissionSettings& settings, const MissionProgress& progress) {
  return Mission(truth, team, settings).run(progress);
}

}  // namespace outrider::explorer
