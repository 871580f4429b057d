#include "auction/allocation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace outrider::auction {
namespace {

constexpr double kNone = -std::numeric_limits<double>::infinity();

bool row_major(Cell a, Cell b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }

double gauss(Point a, Point b, double r) {
  const double dx = a.x - b.x, dy = a.y - b.y;
  return std::exp(-(dx * dx + dy * dy) / (r * r));
}

/// One robot's and task's best bid in a scan over the table.
struct Best {
  std::size_t robot = 0, task = 0;
  double value = kNone;
};

/// U_p2 (eq. 2) for every robot and task, kept up to date while robots win targets.
class Influence {
 public:
  Influence(const BidTable& table, double gamma, const Clear& clear) : table_(table), gamma_(gamma) {
    const std::size_t n = table.robots();
    sees_.resize(n * n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j)
        sees_[i * n + j] = i != j && clear(table.sheet(i).pose.position(), table.sheet(j).pose.position());
    u_p2_.assign(n * table.tasks(), 0.0);
    for (std::size_t l = 0; l < n; ++l) add(l, table.sheet(l).pose.position(), -gamma_);
  }

  double operator()(std::size_t i, std::size_t p) const { return u_p2_[i * table_.tasks() + p]; }

  /// Robot j now has target p: its influence moves from its place to its target.
  void set_target(std::size_t j, std::size_t p) {
    add(j, table_.sheet(j).pose.position(), gamma_);
    add(j, table_.task_point(p), -1.0);
  }

 private:
  void add(std::size_t j, Point at, double factor) {
    const std::size_t n = table_.robots(), m = table_.tasks();
    const double r = table_.sheet(j).range;
    for (std::size_t p = 0; p < m; ++p) {
      const double g = factor * gauss(table_.task_point(p), at, r);
      for (std::size_t i = 0; i < n; ++i)
        if (sees_[i * n + j]) u_p2_[i * m + p] += g;
    }
  }

  const BidTable& table_;
  double gamma_;
  std::vector<char> sees_;  // n x n; vector<bool> would be slower here
  std::vector<double> u_p2_;
};

}  // namespace

BidTable::BidTable(std::span<const BidSheet> sheets, const GridGeometry& geometry)
    : geometry_(geometry), sheets_(sheets.begin(), sheets.end()) {
  std::sort(sheets_.begin(), sheets_.end(), [](const auto& a, const auto& b) { return a.robot < b.robot; });
  for (const auto& sheet : sheets_)
    for (const auto& entry : sheet.entries) tasks_.push_back(entry.task);
  std::sort(tasks_.begin(), tasks_.end(), row_major);
  tasks_.erase(std::unique(tasks_.begin(), tasks_.end()), tasks_.end());
  entries_.assign(sheets_.size() * tasks_.size(), nullptr);
  for (std::size_t i = 0; i < sheets_.size(); ++i)
    for (const auto& entry : sheets_[i].entries) {
      const auto p = std::lower_bound(tasks_.begin(), tasks_.end(), entry.task, row_major) - tasks_.begin();
      entries_[i * tasks_.size() + static_cast<std::size_t>(p)] = &entry;
    }
}

Award BidTable::award(std::size_t i, std::size_t p, double value) const {
  return {sheets_[i].robot, tasks_[p], entry(i, p)->stand, value};
}

std::vector<Award> sequential_auction(const BidTable& table, BidRule rule, const BidParameters& parameters, Turn turn,
                                      const Clear& clear) {
  const std::size_t n = table.robots(), m = table.tasks();
  Influence influence(table, parameters.gamma, clear);
  std::vector<char> served(n, 0), sold(m, 0);
  const auto best_of = [&](std::size_t i, Best best) {
    for (std::size_t p = 0; p < m; ++p) {
      const BidEntry* entry = table.entry(i, p);
      if (sold[p] || entry == nullptr) continue;
      const BidSheet& sheet = table.sheet(i);
      const double e = rule({entry->gain, influence(i, p), entry->distance, sheet.speed, sheet.explored_rate}, parameters);
      if (e > best.value) best = {i, p, e};
    }
    return best;
  };
  std::vector<Award> awards;
  for (std::size_t stage = 0; stage < n; ++stage) {
    Best best;
    if (turn == Turn::kRobotOrder) {
      best = best_of(stage, best);
    } else {
      for (std::size_t i = 0; i < n; ++i)
        if (!served[i]) best = best_of(i, best);
    }
    if (best.value == kNone) {
      if (turn == Turn::kRobotOrder) continue;
      break;
    }
    served[best.robot] = sold[best.task] = 1;
    influence.set_target(best.robot, best.task);
    awards.push_back(table.award(best.robot, best.task, best.value));
  }
  return awards;
}

std::vector<Award> burgard_assignment(const BidTable& table, double beta, const Clear& clear) {
  const std::size_t n = table.robots(), m = table.tasks();
  std::vector<double> u(m, 1.0);
  std::vector<char> served(n, 0), sold(m, 0);
  std::vector<Award> awards;
  for (std::size_t stage = 0; stage < n; ++stage) {
    Best best;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t p = 0; p < m && !served[i]; ++p) {
        const BidEntry* entry = table.entry(i, p);
        if (entry == nullptr || sold[p]) continue;
        const double value = u[p] - beta * entry->distance / table.sheet(i).range;
        if (value > best.value) best = {i, p, value};
      }
    }
    if (best.value == kNone) break;
    served[best.robot] = sold[best.task] = 1;
    const Point target = table.task_point(best.task);
    const double range = table.sheet(best.robot).range;
    for (std::size_t p = 0; p < m; ++p) {
      const double d = distance(target, table.task_point(p));
      if (d < range && clear(target, table.task_point(p))) u[p] -= 1.0 - d / range;
    }
    awards.push_back(table.award(best.robot, best.task, best.value));
  }
  return awards;
}

std::vector<Award> hungarian_assignment(const BidTable& table) {
  const std::size_t n = table.robots(), m = table.tasks();
  std::vector<double> cost(n * m, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t p = 0; p < m; ++p)
      if (const BidEntry* entry = table.entry(i, p)) cost[i * m + p] = entry->distance / table.sheet(i).speed;
  const std::vector<int> task_of = least_cost_assignment(cost, n, m);
  std::vector<Award> awards;
  for (std::size_t i = 0; i < n; ++i)
    if (task_of[i] >= 0) {
      const auto p = static_cast<std::size_t>(task_of[i]);
      awards.push_back(table.award(i, p, -cost[i * m + p]));
    }
  return awards;
}

std::vector<int> least_cost_assignment(std::span<const double> cost, std::size_t rows, std::size_t columns) {
  // Jonker and Volgenant's shortest augmenting paths with potentials. A dummy column a row, dearer than any real
  // assignment, makes every instance feasible; rows that end on one stay unserved.
  constexpr double kInf = std::numeric_limits<double>::infinity();
  double dummy = 1.0;
  for (const double c : cost)
    if (c != kInf) dummy += std::abs(c);
  const std::size_t m = columns + rows;
  const auto at = [&](std::size_t i, std::size_t j) {
    return j < columns ? cost[i * columns + j] : (j == columns + i ? dummy : kInf);
  };
  constexpr std::size_t kFree = static_cast<std::size_t>(-1);
  std::vector<double> u(rows, 0.0), v(m, 0.0), shortest(m);
  std::vector<std::size_t> row_of(m, kFree), column_of(rows, kFree), from(m);
  std::vector<char> scanned(m);
  for (std::size_t start = 0; start < rows; ++start) {
    std::fill(shortest.begin(), shortest.end(), kInf);
    std::fill(scanned.begin(), scanned.end(), 0);
    std::size_t i = start, sink = kFree;
    double reach = 0.0;
    std::vector<std::size_t> tree_rows{start};
    while (sink == kFree) {
      double nearest = kInf;
      std::size_t next = 0;
      for (std::size_t j = 0; j < m; ++j) {
        if (scanned[j]) continue;
        const double reduced = reach + at(i, j) - u[i] - v[j];
        if (reduced < shortest[j]) shortest[j] = reduced, from[j] = i;
        if (shortest[j] < nearest) nearest = shortest[j], next = j;
      }
      reach = nearest;
      scanned[next] = 1;
      if (row_of[next] == kFree) {
        sink = next;
      } else {
        i = row_of[next];
        tree_rows.push_back(i);
      }
    }
    for (const std::size_t row : tree_rows)
      u[row] += row == start ? reach : reach - shortest[column_of[row]];
    for (std::size_t j = 0; j < m; ++j)
      if (scanned[j]) v[j] -= reach - shortest[j];
    for (std::size_t j = sink;;) {  // flip the path
      const std::size_t row = from[j];
      row_of[j] = row;
      std::swap(column_of[row], j);
      if (row == start) break;
    }
  }
  std::vector<int> result(rows, -1);
  for (std::size_t row = 0; row < rows; ++row)
    if (column_of[row] < columns) result[row] = static_cast<int>(column_of[row]);
  return result;
}

}  // namespace outrider::auction
