// The auctions of single items: one task a robot (Dai 2014), and all tasks (Koenig et al. 2006).

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "auction/allocation.hpp"

namespace outrider::auction {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();
constexpr double kFar = 27.6;  // exp(-kFar) = 1e-12: an influence from farther away is none

/// The running auction of one task a robot, greedy and lazy (Minoux 1978): every robot's best bid is kept, an award
/// changes U_p2 only around the winner's place and target, and where that may have lowered a best bid, its value stays
/// as a bound until it is that robot's turn to be asked.
class SequentialAuction {
 public:
  SequentialAuction(const BidTable& table, BidRule rule, const BidParameters& parameters, const Clear& clear)
      : table_(table),
        rule_(rule),
        k_(parameters),
        clear_(clear),
        n_(table.robots()),
        m_(table.tasks()),
        sees_(n_ * n_, kNotAsked),
        u_p2_(n_ * m_, 0.0),
        best_(n_),
        served_(n_, 0),
        sold_(m_, 0) {
    for (std::size_t j = 0; j < n_; ++j) {
      const BidSheet& sheet = table.sheet(j);
      served_[j] = k_.rebid == Rebid::kFinisher && sheet.busy && sheet.goal;
      if (served_[j])
        keep(j, *sheet.goal);
      else
        spread(j, {{sheet.pose.position(), -k_.gamma}});
    }
  }

  std::vector<Award> run() {
    std::vector<Award> awards;
    for (std::size_t stage = 0; stage < n_; ++stage) {
      const std::size_t i = k_.turn == Turn::kRobotOrder ? stage : best_robot();
      if (i == n_) break;
      if (served_[i] || best(i).value == kNone) continue;
      const Best won = best_[i];
      served_[i] = 1;
      sell(won.task);
      awards.push_back(table_.award(i, won.task, won.value));
      spread(i, {{table_.sheet(i).pose.position(), k_.gamma}, {table_.task_point(won.task), -1.0}});
    }
    return awards;
  }

 private:
  static constexpr signed char kNotAsked = -1;

  struct Best {
    std::size_t task = 0;
    double value = -kNone;  // when stale: no bid of the robot is above it
    bool stale = true;
  };
  struct Source {
    Point at;
    double factor;
  };

  double bid(std::size_t i, std::size_t p) const {
    const BidEntry* entry = table_.entry(i, p);
    if (entry == nullptr || sold_[p]) return kNone;
    const BidSheet& sheet = table_.sheet(i);
    const double d = k_.way == Way::kShortest ? static_cast<double>(entry->distance)
                                              : distance(sheet.pose.position(), table_.task_point(p));
    return rule_({entry->gain, u_p2_[i * m_ + p], d, sheet.speed, sheet.explored_rate}, k_);
  }

  const Best& best(std::size_t i) {
    if (!best_[i].stale) return best_[i];
    best_[i] = {0, kNone, false};
    for (std::size_t p = 0; p < m_; ++p)
      if (const double e = bid(i, p); e > best_[i].value) best_[i] = {p, e, false};
    return best_[i];
  }

  /// The robot whose turn it is by its bid; n_ when nobody bids.
  std::size_t best_robot() {
    for (;;) {
      std::size_t robot = n_;
      double value = kNone;
      for (std::size_t i = 0; i < n_; ++i)
        if (!served_[i] && best_[i].value > value) value = best_[i].value, robot = i;
      if (robot == n_ || !best_[robot].stale) return robot;
      best(robot);
    }
  }

  void sell(std::size_t task) {
    sold_[task] = 1;
    for (Best& b : best_) b.stale = b.stale || b.task == task;
  }

  /// Robot j is on its way to `goal`: its target from the beginning, and nobody else's.
  void keep(std::size_t j, Cell goal) {
    spread(j, {{table_.goal_point(j), -1.0}});
    for (std::size_t p = 0; p < m_; ++p)
      if (table_.task(p) == goal) sell(p);
  }

  /// Eq. 2: robot j's influence changes by that of these sources, for everybody else who sees it.
  void spread(std::size_t j, std::initializer_list<Source> sources) {
    const double r2 = table_.sheet(j).range * table_.sheet(j).range;
    near_.clear();
    for (std::size_t p = 0; p < m_; ++p) {
      double change = 0.0;
      for (const auto& [at, factor] : sources) {
        const Point c = table_.task_point(p);
        const double x = ((c.x - at.x) * (c.x - at.x) + (c.y - at.y) * (c.y - at.y)) / r2;
        if (x < kFar) change += factor * std::exp(-x);
      }
      if (change != 0.0) near_.emplace_back(p, change);
    }
    for (std::size_t i = 0; i < n_ && !near_.empty(); ++i)
      if (i != j && !served_[i] && sees(i, j)) feel(i);
  }

  void feel(std::size_t i) {
    Best& b = best_[i];
    for (const auto& [p, change] : near_) {
      u_p2_[i * m_ + p] += change;
      if (change < 0.0) {
        b.stale = b.stale || p == b.task;
      } else if (const double e = bid(i, p); e > b.value || (e == b.value && e != kNone && p < b.task)) {
        b = {p, e, b.stale};
      }
    }
  }

  bool sees(std::size_t i, std::size_t j) {
    if (!k_.sight) return true;
    signed char& answer = sees_[std::min(i, j) * n_ + std::max(i, j)];
    if (answer == kNotAsked) answer = clear_(table_.sheet(i).pose.position(), table_.sheet(j).pose.position());
    return answer != 0;
  }

  const BidTable& table_;
  BidRule rule_;
  const BidParameters& k_;
  const Clear& clear_;
  std::size_t n_, m_;
  std::vector<signed char> sees_;  // n x n, the lower robot first
  std::vector<double> u_p2_;       // n x m
  std::vector<Best> best_;
  std::vector<char> served_, sold_;
  std::vector<std::pair<std::size_t, double>> near_;  // tasks whose influence changes, and by how much
};

/// The running auction of all tasks: tours grow at their ends.
class AllTasksAuction {
 public:
  explicit AllTasksAuction(const BidTable& table) : table_(table), robots_(table.robots()), left_(table.tasks()) {
    std::iota(left_.begin(), left_.end(), std::size_t{0});
    for (std::size_t p = 0; p < table.tasks(); ++p) points_.push_back(table.task_point(p));
    for (std::size_t i = 0; i < robots_.size(); ++i) find_best(i);
  }

  std::vector<Award> run() {
    std::vector<Award> awards;
    while (!left_.empty()) {
      const auto first = std::min_element(robots_.begin(), robots_.end(),
                                          [](const Robot& a, const Robot& b) { return a.best_s < b.best_s; });
      if (first == robots_.end() || first->best_s == -kNone) break;
      const auto winner = static_cast<std::size_t>(first - robots_.begin());
      const std::size_t task = first->best;
      awards.push_back(table_.award(winner, task, -first->best_s));
      first->last = points_[task];
      first->free_s = first->best_s;
      first->under_way = true;
      left_.erase(std::lower_bound(left_.begin(), left_.end(), task));
      for (std::size_t i = 0; i < robots_.size(); ++i)
        if (i == winner || robots_[i].best == task) find_best(i);
    }
    return awards;
  }

 private:
  struct Robot {
    Point last;              // its last task
    double free_s = 0.0;     // when it is there
    bool under_way = false;  // has won a task
    std::size_t best = 0;
    double best_s = -kNone;  // when it could be at `best`
  };

  void find_best(std::size_t i) {
    Robot& robot = robots_[i];
    const double speed = table_.sheet(i).speed;
    double nearest = -kNone;
    for (const std::size_t p : left_) {
      const BidEntry* entry = table_.entry(i, p);
      if (entry == nullptr) continue;
      const double dx = points_[p].x - robot.last.x, dy = points_[p].y - robot.last.y;
      const double d2 = robot.under_way ? dx * dx + dy * dy
                                        : static_cast<double>(entry->distance) * static_cast<double>(entry->distance);
      if (d2 < nearest) nearest = d2, robot.best = p;
    }
    robot.best_s = robot.free_s + std::sqrt(nearest) / speed;
  }

  const BidTable& table_;
  std::vector<Robot> robots_;
  std::vector<std::size_t> left_;  // tasks that nobody has won, ascending
  std::vector<Point> points_;
};

}  // namespace

std::vector<Award> sequential_auction(const BidTable& table, BidRule rule, const BidParameters& parameters,
                                      const Clear& clear) {
  return SequentialAuction(table, rule, parameters, clear).run();
}

std::vector<Award> all_tasks_auction(const BidTable& table) { return AllTasksAuction(table).run(); }

}  // namespace outrider::auction
