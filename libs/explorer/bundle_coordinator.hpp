#pragma once
// The protocols of Lozenguez et al. 2015 while exploring: frontier clusters are the tasks.

#include <memory>
#include <string_view>

#include "explorer/coordinator.hpp"

namespace outrider::explorer {

/// "continuous": Simultaneous Auctions (Algorithm 1) whenever a robot is free; only free robots bid, one task each.
/// "ssa", "dssa": punctual coordination. The auction cycle of auction_coordinator.hpp opens when a robot has nothing left
/// of its bundle; all robots in touch get bundles of several tasks, and work them off in the order of their tours without
/// talking again. With "ssa" the opener runs the synchronised protocol on the sheets; with "dssa" it names the tasks
/// (step 2) and hands them to the nearest robots, and the robots negotiate from there by messages, each with its own map.
std::unique_ptr<Coordinator> make_bundle_coordinator(std::string_view name, const CoordinatorSettings& settings);

}  // namespace outrider::explorer
