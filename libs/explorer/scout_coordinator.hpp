#pragma once

#include <memory>

#include "decision/tour_plan.hpp"
#include "explorer/coordinator.hpp"

namespace outrider::explorer {

/// Parameters of `scout`, the same for all worlds (docs/scout.md). Lengths are fractions of the team's shortest range.
struct ScoutSettings {
  decision::TourPlanSettings plan;
  double block = 0.3;           ///< edge of the blocks that tours lead through
  double pixel = 0.125;         ///< edge of what counts as seen or not
  double most_blocks = 2500.0;  ///< greater blocks when the map would have more
  double replan = 0.5;          ///< plan anew after driving this fraction of the own sensing range
  double forget_s = 20.0;       ///< a silent team-mate is reckoned with for this long [s]
  std::size_t kept_stops = 1;   ///< of the last plan
};

/// Outrider's own: every robot plans tours for all robots it hears of through the world as it hopes it to be, and sets
/// out on its own one; planned anew whenever it has driven a fraction of its sensing range. docs/scout.md.
std::unique_ptr<Coordinator> make_scout_coordinator(const ScoutSettings& settings = {});

}  // namespace outrider::explorer
