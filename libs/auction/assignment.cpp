#include "auction/assignment.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <utility>

namespace outrider::auction {
namespace {

constexpr double kInf = std::numeric_limits<double>::infinity();

/// The growing assignment: rows join one after the other, each by the shortest augmenting path.
class Assignment {
 public:
  Assignment(std::span<const double> cost, std::size_t rows, std::size_t columns)
      : cost_(cost),
        columns_(columns),
        u_(rows, 0.0),
        v_(columns, 0.0),
        row_of_(columns, -1),
        column_of_(rows, -1),
        shortest_(columns),
        from_(columns),
        open_(columns) {
    for (const double c : cost)
      if (c != kInf) unserved_ += std::abs(c);
  }

  void serve(int start) {
    std::fill(shortest_.begin(), shortest_.end(), kInf);
    std::iota(open_.begin(), open_.end(), 0U);
    tree_.clear();
    scanned_.clear();
    std::size_t open = columns_;
    int row = start, sink = -1, leaver = -1;
    double reach = 0.0, leave = kInf;  // the cheapest way to end the path with a row that goes unserved
    while (sink < 0) {
      tree_.push_back({row, reach});
      if (const double without = reach + unserved_ - u_[at(row)]; without < leave) leave = without, leaver = row;
      const std::size_t nearest = scan(row, reach, open);
      const double next = nearest < open ? shortest_[open_[nearest]] : kInf;
      if (leave <= next) {
        reach = leave;
        break;
      }
      reach = next;
      const auto column = open_[nearest];
      open_[nearest] = open_[--open];
      if (row_of_[column] < 0) {
        sink = static_cast<int>(column);
      } else {
        scanned_.push_back(column);
        row = row_of_[column];
      }
    }
    for (const auto& [r, entered] : tree_) u_[at(r)] += reach - entered;
    for (const auto column : scanned_) v_[column] -= reach - shortest_[column];
    if (sink < 0) sink = std::exchange(column_of_[at(leaver)], -1);
    flip(sink, start);
  }

  std::vector<int> columns() && { return std::move(column_of_); }

 private:
  static std::size_t at(int index) { return static_cast<std::size_t>(index); }

  /// Shorter ways to the open columns through `row`; the position in open_ of the nearest one, or `open`.
  std::size_t scan(int row, double reach, std::size_t open) {
    const double* cost = cost_.data() + at(row) * columns_;
    const double base = reach - u_[at(row)];
    double best = kInf;
    std::size_t nearest = open;
    for (std::size_t k = 0; k < open; ++k) {
      const auto column = open_[k];
      const double length = base + cost[column] - v_[column];
      if (length < shortest_[column]) {
        shortest_[column] = length;
        from_[column] = row;
      }
      if (shortest_[column] < best) {
        best = shortest_[column];
        nearest = k;
      }
    }
    return nearest;
  }

  /// Hands columns along the path, from its end back to the row that began it.
  void flip(int column, int start) {
    while (column >= 0) {
      const int row = from_[at(column)];
      row_of_[at(column)] = row;
      column = std::exchange(column_of_[at(row)], column);
      if (row == start) return;
    }
  }

  std::span<const double> cost_;
  std::size_t columns_;
  double unserved_ = 1.0;  // dearer than any real assignment, so that as many rows as possible are served
  std::vector<double> u_, v_;
  std::vector<int> row_of_, column_of_;
  std::vector<double> shortest_;     // to each column, from the row that joins
  std::vector<int> from_;            // the row before it on that way
  std::vector<std::uint32_t> open_;  // columns whose way may still get shorter
  std::vector<std::uint32_t> scanned_;
  std::vector<std::pair<int, double>> tree_;  // rows on the ways, and how far away
};

}  // namespace

std::vector<int> least_cost_assignment(std::span<const double> cost, std::size_t rows, std::size_t columns) {
  Assignment assignment(cost, rows, columns);
  for (std::size_t row = 0; row < rows; ++row) assignment.serve(static_cast<int>(row));
  return std::move(assignment).columns();
}

}  // namespace outrider::auction
