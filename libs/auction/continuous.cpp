#include "auction/continuous.hpp"

#include <algorithm>

#include "auction/ssa.hpp"

namespace outrider::auction {
namespace {

/// The whole mission in simulated time. A robot's clock is what it has driven.
class Continuous {
 public:
  Continuous(int robots, int tasks, const Leg& leg)
      : leg_(leg), at_(static_cast<std::size_t>(robots), -1), over_(static_cast<std::size_t>(robots), 0) {
    result_.order.resize(static_cast<std::size_t>(robots));
    result_.driven.assign(static_cast<std::size_t>(robots), 0.0);
    for (int g = 0; g < tasks; ++g) open_.push_back(g);
  }

  ContinuousResult run() {
    while (!open_.empty()) {
      const std::vector<int> free = next_free();
      if (free.empty()) break;
      auction(free);
    }
    return std::move(result_);
  }

 private:
  /// The robots that finish next, all at the same time.
  std::vector<int> next_free() const {
    double now = kImpossible;
    for (std::size_t i = 0; i < at_.size(); ++i)
      if (!over_[i]) now = std::min(now, result_.driven[i]);
    std::vector<int> free;
    for (std::size_t i = 0; i < at_.size(); ++i)
      if (!over_[i] && result_.driven[i] == now) free.push_back(static_cast<int>(i));
    return free;
  }

  void auction(const std::vector<int>& free) {
    std::vector<double> utilities;
    for (const int i : free)
      for (const int g : open_) utilities.push_back(-leg_(i, at_[static_cast<std::size_t>(i)], g));
    ++result_.auctions;
    result_.messages += utilities.size();
    std::vector<char> served(free.size(), 0);
    std::vector<int> sold;
    for (const Match& match :
         simultaneous_auctions(utilities, static_cast<int>(free.size()), static_cast<int>(open_.size()))) {
      const auto k = static_cast<std::size_t>(match.robot);
      const int robot = free[k], task = open_[static_cast<std::size_t>(match.task)];
      const auto i = static_cast<std::size_t>(robot);
      served[k] = 1;
      sold.push_back(task);
      result_.driven[i] += leg_(robot, at_[i], task);
      result_.order[i].push_back(task);
      at_[i] = task;
    }
    std::erase_if(open_, [&](int g) { return std::find(sold.begin(), sold.end(), g) != sold.end(); });
    for (std::size_t k = 0; k < free.size(); ++k)  // what is left it cannot reach, now or later
      if (!served[k]) over_[static_cast<std::size_t>(free[k])] = 1;
  }

  const Leg& leg_;
  std::vector<int> at_;     // last task of each robot; -1: its start
  std::vector<char> over_;  // robots that get no more tasks
  std::vector<int> open_;
  ContinuousResult result_;
};

}  // namespace

ContinuousResult continuous_coordination(int robots, int tasks, const Leg& leg) {
  return Continuous(robots, tasks, leg).run();
}

}  // namespace outrider::auction
