#include "explorer/known_map_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "decision/coverage_plan.hpp"
#include "decision/passability.hpp"
#include "decision/tour_moves.hpp"
#include "explorer/known_map_views.hpp"
#include "explorer/mission.hpp"

namespace outrider::explorer {
namespace {

constexpr std::size_t kMostWayPoints = 900;       // of the lattice
constexpr int kMostBlocks = 4096;                 // of the coarse plan
constexpr int kCoarse = 5;                        // evaluations of it for one cell by cell
constexpr double kWayPointCost = 0.05;            // [s]
constexpr int kNearOf = 24;                       // draws of which the nearest counts as near
constexpr double kHot = 0.0005, kCold = 0.00003;  // temperature at the ends, parts of the plan's time

using Tours = std::vector<std::vector<Cell>>;

class Planner {
 public:
  Planner(const OccupancyGrid& truth, const std::vector<RobotSpec>& team, const KnownMapPlanOptions& options)
      : truth_(truth),
        team_(team),
        options_(options),
        random_(options.seed),
        counts_(reachable_area(truth, team)),
        seen_(truth.geometry(), 0) {
    for (const RobotSpec& robot : team) {
      auto& mask = masks_.try_emplace(robot.radius).first->second;
      if (mask.size() == 0) mask = decision::passable_mask(truth, robot.radius);
      auto& views = views_[{robot.range, robot.radius}];
      if (!views) views = std::make_unique<Views>(truth, mask, robot.range);
      robots_.push_back({views.get(), truth.geometry().cell_of(robot.start.position()), robot.speed});
    }
    const auto all = std::count(counts_.data().begin(), counts_.data().end(), 1);
    aim_ = static_cast<int>(std::ceil(options.fraction * static_cast<double>(all) - 1e-9));
    choose_lattice();
  }

  /// The best of these tours, or what the search makes of what a coarse plan makes of it.
  KnownMapPlan plan(const std::vector<Tours>& starts) {
    Tours best(robots_.size());
    double best_cost = cost_of(best);
    bool reaches = seen_count_ >= aim_;
    const auto consider = [&](const Tours& tours, double cost) {
      const bool own = seen_count_ >= aim_;
      if (own < reaches || (own == reaches && cost >= best_cost)) return;
      reaches = own;
      best_cost = cost;
      best = tours;
    };
    for (const Tours& start : starts) consider(start, cost_of(start));
    Tours tours = options_.evaluations > 0 ? coarse(best) : best;
    double cost = cost_of(tours);
    consider(tours, cost);
    for (int k = 0; k < options_.evaluations; ++k) {
      const double heat = kHot * std::pow(kCold / kHot, static_cast<double>(k) / options_.evaluations) * best_cost;
      Tours changed = tours;
      change(changed);
      const double changed_cost = cost_of(changed);
      if (changed_cost > cost && std::exp((cost - changed_cost) / heat) < uniform()) continue;
      tours = std::move(changed);
      cost = changed_cost;
      consider(tours, cost);
    }
    const double time_s = evaluate(best);
    return {reaches ? std::optional(time_s) : std::nullopt, std::move(best)};
  }

 private:
  struct Robot {
    Views* views;
    Cell start;
    double speed;  // [m/s]
  };
  /// A robot while its tour is played.
  struct Player {
    const Leg* leg = nullptr;
    std::size_t step = 0, next = 0;  // in the leg; of the tour
    Cell at;
    double next_s = 0.0;  // when it will be in the next cell; infinite at the end
  };

  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }
  double uniform() { return static_cast<double>(random_() >> 11U) * 0x1p-53; }

  /// Way-points as dense as fits, on cells where the slimmest robot can be, and the starts.
  void choose_lattice() {
    const GridGeometry& g = truth_.geometry();
    const Grid<std::uint8_t>& passable = masks_.begin()->second;
    for (int spacing = 2; spacing == 2 || lattice_.size() > kMostWayPoints; ++spacing) {
      lattice_.clear();
      for (int y = std::min(spacing, g.height) / 2; y < g.height; y += spacing)
        for (int x = std::min(spacing, g.width) / 2; x < g.width; x += spacing)
          if (counts_[Cell{x, y}] && passable[Cell{x, y}]) lattice_.push_back({x, y});
    }
    for (const Robot& robot : robots_) lattice_.push_back(robot.start);
  }

  /// What the search makes small: the time, and a little for each way-point, so that those that do nothing go.
  double cost_of(const Tours& tours) {
    std::size_t points = 0;
    for (const auto& tour : tours) points += tour.size();
    return evaluate(tours) + kWayPointCost * static_cast<double>(points);
  }

  bool see(const std::vector<std::uint32_t>& cells) {
    for (const std::uint32_t i : cells) {
      if (seen_[i] == stamp_) continue;
      seen_[i] = stamp_;
      seen_count_ += counts_[i];
    }
    return seen_count_ >= aim_;
  }

  void begin_step(const Robot& robot, const std::vector<Cell>& tour, Player& p, double now_s) {
    while (p.leg == nullptr || p.step == p.leg->size()) {
      if (p.next == tour.size()) {
        p.next_s = std::numeric_limits<double>::infinity();
        return;
      }
      p.leg = &robot.views->leg(p.at, tour[p.next]);
      if (!p.leg->empty()) p.at = tour[p.next];
      p.step = 0;
      ++p.next;
    }
    p.next_s = now_s + (*p.leg)[p.step].metres / robot.speed;
  }

  /// When the aim is reached; plans that never do get their end and a fine by what is missing.
  double evaluate(const Tours& tours) {
    ++stamp_;
    seen_count_ = 0;
    players_.assign(robots_.size(), {});
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      players_[r].at = robots_[r].start;
      see(robots_[r].views->view(robots_[r].start));
      begin_step(robots_[r], tours[r], players_[r], 0.0);
    }
    if (seen_count_ >= aim_) return 0.0;
    double now_s = 0.0;
    for (;;) {
      const auto first = std::min_element(players_.begin(), players_.end(),
                                          [](const Player& a, const Player& b) { return a.next_s < b.next_s; });
      if (first->next_s == std::numeric_limits<double>::infinity()) break;
      now_s = first->next_s;
      if (see(*(*first->leg)[first->step].seen)) return now_s;
      ++first->step;
      const auto r = static_cast<std::size_t>(first - players_.begin());
      begin_step(robots_[r], tours[r], *first, now_s);
    }
    return now_s + fine_s(aim_ - seen_count_);
  }

  /// What the missing cells would cost a team that sweeps badly. The search may pass through plans that miss some; it
  /// never keeps one.
  double fine_s(int missing) const {
    double rate = 0.0;
    for (const RobotSpec& robot : team_) rate += 0.2 * robot.speed * robot.range;
    return missing * truth_.geometry().cell_area() / rate;
  }

  /// Plans on blocks first, from the best of `starts`: cheaper by far than cell by cell, and nearly as true.
  Tours coarse(const Tours& start) {
    int block = 1;
    while ((truth_.width() / block + 1) * (truth_.height() / block + 1) > kMostBlocks) ++block;
    decision::CoverageGround ground(truth_, masks_.rbegin()->second, counts_, block);
    std::vector<decision::CoverageRobot> robots;
    decision::CoverageTours tours(robots_.size());
    for (std::size_t r = 0; r < robots_.size(); ++r) {
      robots.push_back({ground.node_of(robots_[r].start), team_[r].speed, team_[r].range});
      for (const Cell c : start[r])
        if (const auto node = ground.node_of(c); ground.drivable(node) && (tours[r].empty() || tours[r].back() != node))
          tours[r].push_back(node);
    }
    decision::CoveragePlanner planner(ground, std::move(robots), {});
    tours = planner.improve(std::move(tours), kCoarse * options_.evaluations, random_);
    Tours plan(robots_.size());
    for (std::size_t r = 0; r < robots_.size(); ++r)
      for (const auto node : tours[r]) plan[r].push_back(ground.cell_of(node));
    return plan;
  }

  /// A way-point that is rather near to `c` than far from it.
  Cell near(Cell c) {
    Cell nearest = lattice_[below(lattice_.size())];
    const auto away = [&](Cell other) { return std::hypot(other.x - c.x, other.y - c.y); };
    for (int k = 1; k < kNearOf; ++k)
      if (const Cell other = lattice_[below(lattice_.size())]; away(other) < away(nearest)) nearest = other;
    return nearest;
  }

  void change(Tours& tours) {
    const std::size_t a = below(tours.size()), b = below(tours.size());
    auto& tour = tours[a];
    const std::size_t i = tour.empty() ? 0 : below(tour.size());
    const auto at = [](auto& list, std::size_t k) { return list.begin() + static_cast<std::ptrdiff_t>(k); };
    switch (tour.empty() ? 2 : below(6)) {
      case 0: {  // move some
        const std::size_t n = std::min(tour.size() - i, 1 + below(4));
        std::vector<Cell> some = decision::take_stretch(tour, i, n);
        if (below(2) == 0) std::reverse(some.begin(), some.end());
        tours[b].insert(at(tours[b], below(tours[b].size() + 1)), some.begin(), some.end());
        break;
      }
      case 1:
        tour[i] = near(tour[i]);
        break;
      case 2:
        tour.insert(at(tour, tour.empty() ? 0 : i), near(tour.empty() ? robots_[a].start : tour[i]));
        break;
      case 3:
        tour.erase(at(tour, i));
        break;
      case 4:
        decision::reverse_stretch(tour, i, below(tour.size()));
        break;
      default:
        if (a != b) decision::exchange_tails(tour, i, tours[b], below(tours[b].size() + 1));
    }
  }

  const OccupancyGrid& truth_;
  const std::vector<RobotSpec>& team_;
  KnownMapPlanOptions options_;
  std::mt19937_64 random_;
  Grid<std::uint8_t> counts_;  // 1: belongs to the reachable area
  Grid<std::uint32_t> seen_;   // == stamp_: seen in this evaluation
  std::uint32_t stamp_ = 1;
  int seen_count_ = 0, aim_ = 0;
  std::map<double, Grid<std::uint8_t>> masks_;                         // by radius
  std::map<std::pair<double, double>, std::unique_ptr<Views>> views_;  // by range and radius
  std::vector<Robot> robots_;
  std::vector<Cell> lattice_;
  std::vector<Player> players_;
};

/// The tours that a coordinator without knowledge drives: a way-point every few cells.
Tours tours_of(const std::string& coordinator, const OccupancyGrid& truth, const std::vector<RobotSpec>& team,
               double fraction) {
  constexpr double kApart = 3.0;  // [cells]
  constexpr double kMore = 0.02;  // what goes straight between way-points sees a little less than the run
  MissionSettings settings;
  settings.coordinator = coordinator;
  settings.until = std::min(1.0, fraction + kMore);
  settings.record_events = false;
  const MissionResult result = run_mission(truth, team, settings);
  Tours tours;
  for (const MissionRobot& robot : result.robots) {
    std::vector<Cell> tour;
    Point last = robot.trajectory.front().pose.position();
    for (const TimedPose& p : robot.trajectory) {
      if (&p != &robot.trajectory.back() && distance(p.pose.position(), last) < kApart * truth.geometry().resolution)
        continue;
      last = p.pose.position();
      tour.push_back(truth.geometry().cell_of(last));
    }
    tours.push_back(std::move(tour));
  }
  return tours;
}

}  // namespace

KnownMapPlan plan_with_known_map(const OccupancyGrid& truth, const std::vector<RobotSpec>& team,
                                 const KnownMapPlanOptions& options) {
  std::vector<Tours> starts;
  for (const CoordinatorInfo& known : coordinators())
    if (std::find(options.begin_with.begin(), options.begin_with.end(), known.name) != options.begin_with.end())
      starts.push_back(tours_of(known.name, truth, team, options.fraction));
  return Planner(truth, team, options).plan(starts);
}

}  // namespace outrider::explorer
