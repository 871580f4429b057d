#pragma once
// The optimal one-task assignment: the reference beside every auction.

#include <cstddef>
#include <span>
#include <vector>

namespace outrider::auction {

/// Least-cost assignment of rows to columns: result[row] = column or -1. `cost` is row-major rows x columns; infinity
/// marks a forbidden pair. Serves as many rows as possible, then the least total cost. Shortest augmenting paths
/// (Jonker and Volgenant 1987), O(rows^2 columns); about 10 us for 10 x 100.
std::vector<int> least_cost_assignment(std::span<const double> cost, std::size_t rows, std::size_t columns);

}  // namespace outrider::auction
