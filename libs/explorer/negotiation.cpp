#include "explorer/negotiation.hpp"

#include <algorithm>
#include <limits>
#include <random>

namespace outrider::explorer {
namespace {

class Team {
 public:
  Team(int robots, const MakeNegotiator& make, const NegotiationSettings& settings)
      : settings_(settings), random_(settings.seed),
        ether_(robots, [this](RobotId, RobotId, double) { return fate(); }),
        next_s_(static_cast<std::size_t>(robots)), dies_s_(next_s_.size(), std::numeric_limits<double>::infinity()),
        echoes_(next_s_.size()) {
    for (RobotId i = 0; i < robots; ++i) minds_.push_back(make(i));
    for (double& t : next_s_) t = settings.act_s * unit();
    for (const auto& [robot, t] : settings.deaths) {
      dies_s_[static_cast<std::size_t>(robot)] = t;
      calm_s_ = std::max(calm_s_, t + 2.0 * settings.times.dead_s);
    }
  }

  NegotiationResult run() {
    NegotiationResult result;
    double now_s = 0.0;
    while (true) {
      const auto i = static_cast<std::size_t>(std::min_element(next_s_.begin(), next_s_.end()) - next_s_.begin());
      now_s = next_s_[i];
      if (now_s > settings_.most_s) break;
      next_s_[i] = now_s + settings_.act_s * (0.5 + unit());
      if (now_s >= dies_s_[i]) {
        next_s_[i] = std::numeric_limits<double>::infinity();
        continue;
      }
      act(i, now_s);
      note(result, i, now_s);
      if (now_s >= calm_s_ && all_done(now_s)) {
        result.agreed = true;
        break;
      }
    }
    for (std::size_t i = 0; i < minds_.size(); ++i) {
      result.allocation.push_back(now_s < dies_s_[i] ? minds_[i]->tasks() : TaskSet{});
      result.modifications.push_back(minds_[i]->modifications());
    }
    result.duration_s = now_s;
    result.radio = ether_.counters();
    return result;
  }

 private:
  double unit() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }

  std::optional<double> fate() {
    if (settings_.loss > 0.0 && unit() < settings_.loss) return std::nullopt;
    return 2.0 * settings_.delay_s * unit();
  }

  void act(std::size_t i, double now_s) {
    ether_.set_time(now_s);
    auto& echoes = echoes_[i];
    for (auto& delivery : ether_.endpoint(static_cast<RobotId>(i)).receive()) {
      minds_[i]->hear(*delivery.message, now_s);
      if (settings_.duplicate > 0.0 && unit() < settings_.duplicate) echoes.emplace_back(now_s + unit(), delivery.message);
    }
    for (const auto& [due_s, message] : echoes)
      if (due_s <= now_s) minds_[i]->hear(*message, now_s);
    std::erase_if(echoes, [&](const auto& echo) { return echo.first <= now_s; });
    for (Message& message : minds_[i]->act(now_s)) ether_.endpoint(static_cast<RobotId>(i)).send(std::move(message));
  }

  void note(NegotiationResult& result, std::size_t i, double now_s) const {
    if (!result.history.empty() && result.history.back().tasks[i] == minds_[i]->tasks()) return;
    result.history.push_back({now_s, {}});
    for (const auto& mind : minds_) result.history.back().tasks.push_back(mind->tasks());
  }

  bool all_done(double now_s) const {
    for (std::size_t i = 0; i < minds_.size(); ++i)
      if (now_s < dies_s_[i] && !minds_[i]->done()) return false;
    return true;
  }

  const NegotiationSettings& settings_;
  std::mt19937_64 random_;
  link::Ether ether_;
  std::vector<std::unique_ptr<auction::Negotiator>> minds_;
  std::vector<double> next_s_, dies_s_;
  std::vector<std::vector<std::pair<double, std::shared_ptr<const Message>>>> echoes_;  // to be heard again
  double calm_s_ = 0.0;  // no robot dies, or is noticed missing, after it
};

}  // namespace

NegotiationResult negotiate(int robots, const MakeNegotiator& make, const NegotiationSettings& settings) {
  return Team(robots, make, settings).run();
}

}  // namespace outrider::explorer
