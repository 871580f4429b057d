#include "explorer/dvf_coordinator.hpp"

#include <algorithm>
#include <map>

#include "decision/dvf.hpp"
#include "decision/passability.hpp"

namespace outrider::explorer {
namespace {

constexpr double kPeriod = 1.0;  // [s] between decisions: "computing a new policy every second in average"

enum class Others {
  kIgnored,  ///< eq. 1
  kHeard,    ///< eq. 6: Omega(i), those in communication now
  kKnown,    ///< eq. 3: everybody, the silent ones where they were last heard
};

class DvfCoordinator : public Coordinator {
 public:
  DvfCoordinator(Others others, const decision::DvfReading& reading)
      : others_(others), intentions_(reading.intentions), planner_(reading) {}

  Decision decide(const Situation& s) override {
    const bool due = s.needs_task || (s.task && s.now_s >= plan_at_s_);
    if (!due) return {};
    plan_at_s_ = s.now_s + kPeriod;
    const std::vector<BidEntry> entries = s.tasks({.gains = false});
    std::vector<Cell> goals;
    for (const BidEntry& e : entries) goals.push_back(e.stand);
    const auto plan = planner_.plan(s.passable.mask(), s.at, goals, rivals(s));
    if (!plan) return {.verdict = s.task ? Decision::Verdict::kKeep : Decision::Verdict::kNothing};
    const auto chosen = std::find(goals.begin(), goals.end(), plan->goal) - goals.begin();
    const BidEntry& entry = entries[static_cast<std::size_t>(chosen)];
    return {.verdict = Decision::Verdict::kGo, .task = Task{entry.task, entry.stand}, .value = plan->value};
  }

 private:
  /// The others as far as they matter; who has nothing left to explore does not.
  std::vector<decision::Rival> rivals(const Situation& s) {
    std::vector<decision::Rival> result;
    if (others_ == Others::kIgnored) return result;
    kinds_.clear();
    for (const Teammate& mate : others_ == Others::kHeard ? s.team : s.known) {
      if (mate.status.done) continue;
      const Cell at = s.map.geometry().cell_of(mate.status.pose.position());
      if (!s.map.contains(at)) continue;
      result.push_back({at, mate.status.radius == s.spec.radius ? nullptr : &mask_of(mate.status.radius, s.map),
                        intentions_ ? mate.status.goal : std::nullopt});
    }
    return result;
  }

  const Grid<std::uint8_t>& mask_of(double radius, const OccupancyGrid& map) {
    auto kind = kinds_.find(radius);
    if (kind == kinds_.end()) kind = kinds_.emplace(radius, decision::passable_mask(map, radius)).first;
    return kind->second;
  }

  Others others_;
  bool intentions_;
  decision::DvfPlanner planner_;
  std::map<double, Grid<std::uint8_t>> kinds_;  // masks of the other kinds, for one decision
  double plan_at_s_ = 0.0;
};

}  // namespace

std::unique_ptr<Coordinator> make_dvf_coordinator(std::string_view name, const CoordinatorSettings& settings) {
  const Others others = name == "dvf" ? Others::kKnown : name == "dvf-reactive" ? Others::kHeard : Others::kIgnored;
  return std::make_unique<DvfCoordinator>(others, settings.dvf);
}

}  // namespace outrider::explorer
