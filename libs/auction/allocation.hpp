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
  BidTable(std::span<const BidSheet> sheets, const GridGeometry& geometry);

  std::size_t robots() const { return sheets_.size(); }
  std::size_t tasks() const { return tasks_.size(); }
  const BidSheet& sheet(std::size_t i) const { return sheets_[i]; }
  Cell task(std::size_t p) const { return tasks_[p]; }
  Point task_point(std::size_t p) const { return geometry_.center(tasks_[p]); }
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

/// Who is served next in the sequential auction (the paper allows both readings).
enum class Turn {
  kBestBid,     ///< the best bid of all robots that have no task yet
  kRobotOrder,  ///< R_1, R_2, ..., each its own best
};

/// Sequential single-item auction (Dai 2014, section 4): one task a robot, U_p2 of eq. 2 follows every award.
/// O(n^2 m) evaluations at most, 2 n m exponentials. Ties: lower robot, then lower task.
std::vector<Award> sequential_auction(const BidTable& table, BidRule rule, const BidParameters& parameters, Turn turn,
                                      const Clear& clear);

/// Burgard et al. 2005: U_t - beta V_t^i with V in sensing ranges; the utility of tasks near an awarded one falls
/// with 1 - d / range.
std::vector<Award> burgard_assignment(const BidTable& table, double beta, const Clear& clear);

/// The assignment of one task a robot with the least total travel time (shortest augmenting paths, O(n^2 m)).
/// As many robots as possible are served.
std::vector<Award> hungarian_assignment(const BidTable& table);

/// Least-cost assignment of rows to columns: result[row] = column or -1. `cost` is row-major rows x columns; infinity
/// marks a forbidden pair. Serves as many rows as possible, then the least total cost.
std::vector<int> least_cost_assignment(std::span<const double> cost, std::size_t rows, std::size_t columns);

}  // namespace outrider::auction
