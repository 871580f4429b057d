#pragma once
// A mission allocated by one of the protocols: where the auction room's protocols meet the decision room's costs.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "auction/bundles.hpp"
#include "decision/topo_mission.hpp"
#include "explorer/negotiation.hpp"
#include "explorer/team_costs.hpp"

namespace outrider::explorer {

enum class Protocol { kContinuous, kSsa, kDssa, kOptimal, kScout };
enum class Initial { kEmpty, kRandom, kCurrent, kNearest };
enum class Gains {
  kSum,       ///< eq. 10: costs and a social cost
  kMakespan,  ///< a power mean of the costs
};

std::string_view to_string(Protocol protocol);
std::string_view to_string(Initial initial);
std::string_view to_string(Gains gains);

struct AllocationSettings {
  Protocol protocol = Protocol::kDssa;
  Initial initial = Initial::kEmpty;
  Gains gains = Gains::kSum;
  double noc = 0.1;           ///< eq. 11, of D_max (docs/missions.md)
  bool return_home = false;   ///< J ends where the robot began
  int starts = 16;            ///< of scout's searches
  std::uint64_t seed = 1;
  NegotiationSettings radio;  ///< of dssa and scout; its seed is not used
};

/// One step of a protocol.
struct AllocationStep {
  double t = 0.0;                ///< [s] of negotiation; the number of the iteration for SSA
  std::vector<int> owners;       ///< of each task, -1: nobody (or on its way)
  double value = 0.0;            ///< eq. 7
  std::vector<double> utilities; ///< robots x tasks, eq. 9, before the step; -infinity: cannot; SSA only
  int moves = 0;                 ///< tasks that changed hands
};

struct AllocationResult {
  std::vector<std::vector<int>> order;  ///< goals of each robot as it visits them
  std::vector<double> mission_s;        ///< J_i of each robot
  double duration = 0.0;                ///< of the longest
  double movement = 0.0;                ///< costs of all paths taken
  double value = 0.0;                   ///< eq. 7
  int iterations = 0;                   ///< auctions, or hand-overs
  std::vector<int> modifications;
  std::uint64_t messages = 0;
  std::size_t policy_solves = 0;
  double negotiation_s = 0.0;           ///< simulated
  std::vector<int> undone;              ///< goals that nobody can do
  bool agreed = true;
  std::vector<AllocationStep> steps;
};

/// The problem that `settings` describe. `costs` must outlive it.
auction::BundleProblem bundle_problem(TeamCosts& costs, const AllocationSettings& settings);
/// The allocation that a protocol begins with.
auction::Allocation initial_allocation(const decision::TopoMission& mission, const auction::BundleProblem& problem,
                                       const AllocationSettings& settings);

/// Runs the protocol. Throws InputError when it cannot take so many goals or robots.
AllocationResult allocate(const decision::TopoMission& mission, TeamCosts& costs, const AllocationSettings& settings);

}  // namespace outrider::explorer
