#pragma once
// Beyond the paper: allocations for the least mission duration. Its discussion asks to "detect the robot with the
// longest mission and try to minimize its part"; this does, by moves and swaps from several seeded starts.

#include <cstdint>

#include "auction/bundles.hpp"

namespace outrider::auction {

struct Plan {
  Allocation allocation;
  double makespan = 0.0;  ///< the greatest burden of a robot
  double total = 0.0;
};

/// Fewer tasks left out, then the shorter makespan, the lesser total, then by owners; a strict total order of plans.
bool better(const Plan& a, const Plan& b);

/// Local search for the makespan; `problem.burden` is the cost J_i(S), its unit that of epsilon.
class MakespanSearch {
 public:
  /// `start` numbers the beginnings: 0 is SSA on a power mean, others insert the tasks in a random order of their own,
  /// each where the longest mission stays shortest. `able`: robots that take part. What `problem` refers to must outlive
  /// this.
  MakespanSearch(const BundleProblem& problem, std::uint64_t seed, std::vector<char> able);

  /// From beginning `start` to an allocation in which no move of a task away from the robot with the longest mission, and
  /// no swap with it, shortens the missions (compared longest first).
  Plan search(int start) const;

 private:
  Plan begin(int start) const;
  bool relieve(Plan& plan, std::vector<double>& burden) const;

  BundleProblem problem_;
  std::uint64_t seed_;
  std::vector<char> able_;
};

/// The best of `starts` searches.
Plan least_makespan(const BundleProblem& problem, std::uint64_t seed, int starts);

}  // namespace outrider::auction
