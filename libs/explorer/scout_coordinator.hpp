#pragma once

#include <memory>

#include "explorer/coordinator.hpp"

namespace outrider::explorer {

/// Parameters of `scout`, the same for all worlds (docs/scout.md).
struct ScoutSettings {
  double start = 0.1;       ///< added to every distance, in sensing ranges, so that the nearest task does not win by itself
  double least_left = 0.02; ///< what a task is still worth where a team-mate will see everything
  double clearly = 1.2;     ///< a task is left for one that is worth more by this factor
  double rethink = 0.25;    ///< decides anew after driving this fraction of the own sensing range
  int most_changes = 3;     ///< of mind in a row before a task is seen to its end: nobody dithers for ever
};

/// Outrider's own: every robot weighs what its team-mates will leave it to see against the way there, and thinks again
/// while it drives. No messages but the usual status. docs/scout.md.
std::unique_ptr<Coordinator> make_scout_coordinator(const ScoutSettings& settings = {});

}  // namespace outrider::explorer
