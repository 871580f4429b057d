#pragma once
// Changes of tours that searches over plans of a team are made of. A tour is a vector of way-points.

#include <algorithm>
#include <cstddef>
#include <vector>

namespace outrider::decision {

/// Takes the `n` way-points from the `i`-th on out of the tour.
template <class Point>
std::vector<Point> take_stretch(std::vector<Point>& tour, std::size_t i, std::size_t n) {
  const auto begin = tour.begin() + static_cast<std::ptrdiff_t>(i), end = begin + static_cast<std::ptrdiff_t>(n);
  std::vector<Point> stretch(begin, end);
  tour.erase(begin, end);
  return stretch;
}

/// Turns the way-points from the `i`-th to the `j`-th round, both included; either may be the first.
template <class Point>
void reverse_stretch(std::vector<Point>& tour, std::size_t i, std::size_t j) {
  std::reverse(tour.begin() + static_cast<std::ptrdiff_t>(std::min(i, j)),
               tour.begin() + static_cast<std::ptrdiff_t>(std::max(i, j)) + 1);
}

/// What `a` does from its `i`-th way-point on is done by `b`, and what `b` does from its `j`-th on by `a`.
template <class Point>
void exchange_tails(std::vector<Point>& a, std::size_t i, std::vector<Point>& b, std::size_t j) {
  const std::vector<Point> of_a = take_stretch(a, i, a.size() - i), of_b = take_stretch(b, j, b.size() - j);
  a.insert(a.end(), of_b.begin(), of_b.end());
  b.insert(b.end(), of_a.begin(), of_a.end());
}

}  // namespace outrider::decision
