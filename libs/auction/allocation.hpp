#pragma once
// From bid sheets to awards: who does what, computed the same way by whoever holds the same sheets.

#include <functional>
#include <span>
#include <vector>

#include "auction/bid_rules.hpp"
#include "world/grid.hpp"
#include "world/messages.hpp"

namespace outrider::auction {

/// The sheets of one round as a dense table: robots (by id) x tasks (by row, then column).
class BidTable {
 public:
  /// Copies the sheets. O(robots x tasks).
  BidTable(std::span<const BidSheet> sheets, const GridGeometry& geometry);
  BidTable(const BidTable&) = delete;
  BidTable& operator=(const BidTable&) = delete;

  std::size_t robots() const { return sheets_.size(); }
  std::size_t tasks() const { return tasks_.size(); }
  const BidSheet& sheet(std::size_t i) const { return sheets_[i]; }
  Cell task(std::size_t p) const { return tasks_[p]; }
  Point task_point(std::size_t p) const { return geometry_.center(tasks_[p]); }
  Point goal_point(std::size_t i) const { return geometry_.center(*sheets_[i].goal); }  ///< of a robot that has one
  /// Robot i's bid for task p; null when it made none.
  const BidEntry* entry(std::size_t i, std::size_t p) const { return entries_[i * tasks_.size() + p]; }
  Award award(std::size_t i, std::size_t p, double value) const;

 private:
  GridGeometry geometry_;
  std::vector<BidSheet> sheets_;
  std::vector<Cell> tasks_;
  std::vector<const BidEntry*> entries_;
};

/// True when nothing known blocks the straight line between two points; eq. 2 drops the influence of others.
using Clear = std::function<bool(Point, Point)>;

/// Sequential single-item auction (Dai 2014, section 4): one task a robot, U_p2 of eq. 2 follows every award.
/// Influences below 1e-12 count as none. O(n m) bids at first, then an award touches only the bids near the winner's
/// place and target; in the worst case O(n^2 m). Ties: lower robot, then lower task. With Rebid::kFinisher busy robots
/// win nothing.
std::vector<Award> sequential_auction(const BidTable& table, BidRule rule, const BidParameters& parameters,
                                      const Clear& clear);

/// Burgard et al. 2005: U_t - beta V_t^i with V in sensing ranges; the utility of tasks near an awarded one falls
/// with 1 - d / range.
std::vector<Award> burgard_assignment(const BidTable& table, double beta, const Clear& clear);

/// The assignment of one task a robot with the least total travel time (shortest augmenting paths, O(n^2 m)).
/// As many robots as possible are served.
std::vector<Award> hungarian_assignment(const BidTable& table);

/// Sequential single-item auctions of all tasks (Koenig et al. 2006), for the makespan: task by task goes to the robot
/// that would be there first after all it has won already, straight lines between tasks. Awards in that order; `value`
/// is minus the time of arrival [s]. O(m^2) bids and some.
std::vector<Award> all_tasks_auction(const BidTable& table);
/// The first award of each robot: what it drives to before the next round.
std::vector<Award> first_of_each(std::span<const Award> awards);

/// Total travel time of a round [s], and the least possible for as many robots (the optimal assignment of the same
/// bids).
struct RoundTime {
  double awarded_s = 0.0;
  double least_s = 0.0;
};
/// Awards for tasks that their robots did not bid for are left out of both.
RoundTime round_time(const BidTable& table, std::span<const Award> awards);

}  // namespace outrider::auction
