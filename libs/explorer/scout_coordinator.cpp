#include "explorer/scout_coordinator.hpp"

#include <algorithm>
#include <cmath>

namespace outrider::explorer {
namespace {

class ScoutCoordinator : public Coordinator {
 public:
  explicit ScoutCoordinator(const ScoutSettings& settings) : settings_(settings) {}

  Decision decide(const Situation& s) override {
    if (s.needs_task) changes_ = 0;
    else if (!s.task || s.now_s < rethink_at_s_ || changes_ >= settings_.most_changes) return {};
    rethink_at_s_ = s.now_s + settings_.rethink * s.spec.range / s.spec.speed;
    const std::vector<BidEntry> entries = s.tasks({});
    if (entries.empty()) return {.verdict = s.needs_task ? Decision::Verdict::kNothing : Decision::Verdict::kKeep};
    const BidEntry* best = nullptr;
    double most = 0.0, current = 0.0;
    for (const BidEntry& e : entries) {
      const double value = worth(s, e);
      if (s.task && e.task == s.task->cell) current = value;
      if (best != nullptr && value <= most) continue;
      best = &e;
      most = value;
    }
    if (!s.needs_task) {
      if (most <= settings_.clearly * current) return {};
      ++changes_;
    }
    return {.verdict = Decision::Verdict::kGo, .task = Task{best->task, best->stand}, .value = most};
  }

 private:
  /// The root of the gain: twice the view is not worth twice the way, for small remains cost a long way back later.
  double worth(const Situation& s, const BidEntry& e) const {
    const double way = e.distance / s.spec.range + settings_.start;
    return std::sqrt(e.gain) * std::max(left_by_team(s, e.stand), settings_.least_left) / way;
  }

  /// Share of the view from `stand` that no team-mate will see from its goal: for each of them it falls linearly from
  /// discs that only touch to one disc within the other.
  static double left_by_team(const Situation& s, Cell stand) {
    const auto& g = s.map.geometry();
    double left = 1.0;
    for (const Teammate& mate : s.team) {
      if (!mate.status.goal) continue;
      const double ratio = mate.status.range / s.spec.range;
      const double away = distance(g.center(stand), g.center(*mate.status.goal)) / s.spec.range;
      const double inside = std::abs(ratio - 1.0), touching = ratio + 1.0;
      const double covered = std::clamp((touching - away) / (touching - inside), 0.0, 1.0);
      left *= 1.0 - covered * std::min(1.0, ratio * ratio);
    }
    return left;
  }

  ScoutSettings settings_;
  double rethink_at_s_ = 0.0;
  int changes_ = 0;  // of mind since a task last ended
};

}  // namespace

std::unique_ptr<Coordinator> make_scout_coordinator(const ScoutSettings& settings) {
  return std::make_unique<ScoutCoordinator>(settings);
}

}  // namespace outrider::explorer
