#include "auction/allocation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "auction/assignment.hpp"

namespace outrider::auction {
namespace {

bool row_major(Cell a, Cell b) { return a.y != b.y ? a.y < b.y : a.x < b.x; }
bool by_task(const BidEntry& a, const BidEntry& b) { return row_major(a.task, b.task); }

constexpr double kInf = std::numeric_limits<double>::infinity();

/// Travel times of all bids, robots x tasks [s]; infinity where there is none.
std::vector<double> travel_times(const BidTable& table) {
  const std::size_t n = table.robots(), m = table.tasks();
  std::vector<double> times(n * m, kInf);
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t p = 0; p < m; ++p)
      if (const BidEntry* entry = table.entry(i, p)) times[i * m + p] = entry->distance / table.sheet(i).speed;
  return times;
}

}  // namespace

BidTable::BidTable(std::span<const BidSheet> sheets, const GridGeometry& geometry)
    : geometry_(geometry), sheets_(sheets.begin(), sheets.end()) {
  std::sort(sheets_.begin(), sheets_.end(), [](const auto& a, const auto& b) { return a.robot < b.robot; });
  std::vector<Cell> own, both;
  for (BidSheet& sheet : sheets_) {  // a merge each: sheets of one map hold much the same tasks, in order
    if (!std::is_sorted(sheet.entries.begin(), sheet.entries.end(), by_task))
      std::stable_sort(sheet.entries.begin(), sheet.entries.end(), by_task);
    own.clear();
    for (const BidEntry& entry : sheet.entries)
      if (own.empty() || own.back() != entry.task) own.push_back(entry.task);
    both.clear();
    std::set_union(tasks_.begin(), tasks_.end(), own.begin(), own.end(), std::back_inserter(both), row_major);
    tasks_.swap(both);
  }
  entries_.assign(sheets_.size() * tasks_.size(), nullptr);
  for (std::size_t i = 0; i < sheets_.size(); ++i) {
    std::size_t p = 0;
    for (const BidEntry& entry : sheets_[i].entries) {
      while (tasks_[p] != entry.task) ++p;
      entries_[i * tasks_.size() + p] = &entry;
    }
  }
}

Award BidTable::award(std::size_t i, std::size_t p, double value) const {
  return {sheets_[i].robot, tasks_[p], entry(i, p)->stand, value};
}

std::vector<Award> burgard_assignment(const BidTable& table, double beta, const Clear& clear) {
  const std::size_t n = table.robots(), m = table.tasks();
  std::vector<double> u(m, 1.0);
  std::vector<char> served(n, 0), sold(m, 0);
  std::vector<Award> awards;
  for (std::size_t stage = 0; stage < n; ++stage) {
    std::size_t robot = 0, task = 0;
    double best = -kInf;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t p = 0; p < m && !served[i]; ++p) {
        const BidEntry* entry = table.entry(i, p);
        if (entry == nullptr || sold[p]) continue;
        const double value = u[p] - beta * entry->distance / table.sheet(i).range;
        if (value > best) best = value, robot = i, task = p;
      }
    }
    if (best == -kInf) break;
    served[robot] = sold[task] = 1;
    const Point target = table.task_point(task);
    const double range = table.sheet(robot).range;
    for (std::size_t p = 0; p < m; ++p) {
      const double d = distance(target, table.task_point(p));
      if (d < range && clear(target, table.task_point(p))) u[p] -= 1.0 - d / range;
    }
    awards.push_back(table.award(robot, task, best));
  }
  return awards;
}

std::vector<Award> hungarian_assignment(const BidTable& table) {
  const std::size_t n = table.robots(), m = table.tasks();
  const std::vector<double> times = travel_times(table);
  const std::vector<int> task_of = least_cost_assignment(times, n, m);
  std::vector<Award> awards;
  for (std::size_t i = 0; i < n; ++i)
    if (task_of[i] >= 0) {
      const auto p = static_cast<std::size_t>(task_of[i]);
      awards.push_back(table.award(i, p, -times[i * m + p]));
    }
  return awards;
}

std::vector<Award> first_of_each(std::span<const Award> awards) {
  std::vector<Award> first;
  for (const Award& award : awards)
    if (std::none_of(first.begin(), first.end(), [&](const Award& a) { return a.robot == award.robot; }))
      first.push_back(award);
  return first;
}

RoundTime round_time(const BidTable& table, std::span<const Award> awards) {
  const std::size_t n = table.robots(), m = table.tasks();
  const std::vector<double> times = travel_times(table);
  RoundTime result;
  std::vector<double> winners;  // rows of `times`
  for (const Award& award : awards)
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t p = 0; p < m; ++p) {
        if (table.sheet(i).robot != award.robot || table.task(p) != award.task || times[i * m + p] == kInf) continue;
        result.awarded_s += times[i * m + p];
        const auto row = times.begin() + static_cast<std::ptrdiff_t>(i * m);
        winners.insert(winners.end(), row, row + static_cast<std::ptrdiff_t>(m));
      }
  const std::size_t rows = m == 0 ? 0 : winners.size() / m;
  const std::vector<int> task_of = least_cost_assignment(winners, rows, m);
  for (std::size_t row = 0; row < rows; ++row)
    if (task_of[row] >= 0) result.least_s += winners[row * m + static_cast<std::size_t>(task_of[row])];
  return result;
}

}  // namespace outrider::auction
