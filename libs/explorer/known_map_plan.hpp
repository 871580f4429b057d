#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "world/grid.hpp"
#include "world/robot.hpp"

namespace outrider::explorer {

struct KnownMapPlanOptions {
  double fraction = 0.95;   ///< of the reachable area that has to be seen
  int evaluations = 20000;  ///< of changed plans in the local search
  std::uint64_t seed = 1;
  std::vector<std::string> begin_with{"scout", "daa", "ea"};  ///< coordinators whose runs it may begin with
};

/// How a team could explore if it knew the map: the `oracle` of the benches.
struct KnownMapPlan {
  std::optional<double> time_s;          ///< until `fraction` has been seen; nothing: no plan found sees so much
  std::vector<std::vector<Cell>> tours;  ///< way-points of each robot, from its start on
};

/// A plan for the least time to see `fraction` of the reachable area of `truth`, by local search: from the tours of the
/// best of some real runs, first over blocks of cells (decision::CoveragePlanner), then over a lattice of way-points with
/// what is seen from every cell on the way. Changes are random (a way-point moved, replaced, put in, left out; a stretch
/// reversed; tails of two robots exchanged) under simulated annealing. Robots sense in every cell that they enter, by the
/// simulator's rule, and drive shortest safe paths at their speed; they do not get in each other's way. No better than
/// the optimum and no worse than its beginnings: a reference, not a bound. Deterministic.
KnownMapPlan plan_with_known_map(const OccupancyGrid& truth, const std::vector<RobotSpec>& team,
                                 const KnownMapPlanOptions& options);

}  // namespace outrider::explorer
