#pragma once
// The best allocation there is, by enumeration: the oracle of the protocols.

#include "auction/bundles.hpp"

namespace outrider::auction {

enum class Objective {
  kSum,       ///< the least total burden: G* of eq. 8
  kMakespan,  ///< the least burden of the robot that has most, then the least total
};

inline constexpr int kMostForOptimal = 16;  ///< tasks

/// Dynamic programming over all partitions, O(n 3^|G|) time, n 2^|G| numbers of memory. Tasks that no robot can do are
/// left out. |G| <= kMostForOptimal (assertion).
Allocation optimal_allocation(const BundleProblem& problem, Objective objective);

}  // namespace outrider::auction
