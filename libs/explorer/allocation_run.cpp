#include "explorer/allocation_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "auction/continuous.hpp"
#include "auction/hand_over.hpp"
#include "auction/optimal.hpp"
#include "auction/plan_gossip.hpp"
#include "auction/ssa.hpp"
#include "world/error.hpp"

namespace outrider::explorer {
namespace {

using auction::Allocation;
using auction::BundleProblem;

constexpr double kRounding = 1e-5;  ///< of D_max; costs are floats
constexpr RoundId kRound{0, 1};

std::vector<int> owners_of(const Allocation& allocation, int tasks) {
  std::vector<int> owners(static_cast<std::size_t>(tasks), -1);
  for (std::size_t i = 0; i < allocation.size(); ++i)
    allocation[i].for_each([&](int g) { owners[static_cast<std::size_t>(g)] = static_cast<int>(i); });
  return owners;
}

/// Runs one protocol and fills the result.
class Run {
 public:
  Run(const decision::TopoMission& mission, TeamCosts& costs, const AllocationSettings& settings)
      : mission_(mission), costs_(costs), settings_(settings), problem_(bundle_problem(costs, settings)) {
    result_.modifications.assign(static_cast<std::size_t>(problem_.robots), 0);
  }

  AllocationResult run() {
    switch (settings_.protocol) {
      case Protocol::kContinuous: continuous(); return std::move(result_);
      case Protocol::kSsa: finish(ssa()); break;
      case Protocol::kDssa: finish(negotiated(false)); break;
      case Protocol::kOptimal: finish(optimal()); break;
      case Protocol::kScout: finish(negotiated(true)); break;
    }
    return std::move(result_);
  }

 private:
  /// r_g: more than one task more can ever cost (there, back, and the social cost).
  double reward() const {
    return 2.0 * costs_.diameter() + settings_.noc * costs_.diameter() * problem_.tasks;
  }
  double value_of(const Allocation& allocation) const {
    const int done = problem_.tasks - auction::unallocated(allocation, problem_.tasks).size();
    return reward() * done - auction::total_burden(problem_, allocation);
  }

  void continuous() {
    const auto run = auction::continuous_coordination(
        problem_.robots, problem_.tasks, [&](int i, int from, int g) { return costs_.leg(i, from, g); });
    result_.order = run.order;
    result_.iterations = run.auctions;
    result_.messages = run.messages;
    Allocation allocation = auction::empty_allocation(problem_);
    for (std::size_t i = 0; i < run.order.size(); ++i) {
      const int robot = static_cast<int>(i);
      for (const int g : run.order[i]) allocation[i].insert(g);
      result_.modifications[i] = static_cast<int>(run.order[i].size());
      result_.mission_s.push_back(run.driven[i] + costs_.home(robot, run.order[i].empty() ? -1 : run.order[i].back()));
    }
    total(allocation);
  }

  Allocation ssa() {
    auto run = auction::ssa(problem_, initial_allocation(mission_, problem_, settings_));
    result_.iterations = static_cast<int>(run.iterations.size());
    result_.modifications = run.modifications;
    result_.messages = run.messages;
    std::vector<int> owners = owners_of(initial_allocation(mission_, problem_, settings_), problem_.tasks);
    for (std::size_t k = 0; k < run.iterations.size(); ++k) {
      const auto& iteration = run.iterations[k];
      AllocationStep step{static_cast<double>(k + 1), {}, reward() * iteration.allocated - iteration.burden, {},
                          static_cast<int>(iteration.moves.size())};
      for (const double price : iteration.prices) step.utilities.push_back(reward() - price);
      for (const auto& move : iteration.moves) owners[static_cast<std::size_t>(move.task)] = move.to;
      step.owners = owners;
      result_.steps.push_back(std::move(step));
    }
    return run.allocation;
  }

  Allocation optimal() {
    if (problem_.tasks > auction::kMostForOptimal)
      throw InputError(fmt::format("optimal: {} goals; enumeration can take {} at most", problem_.tasks, auction::kMostForOptimal));
    result_.iterations = 1;
    if (settings_.gains == Gains::kSum) return auction::optimal_allocation(problem_, auction::Objective::kSum);
    return auction::optimal_allocation(cost_problem(), auction::Objective::kMakespan);
  }

  BundleProblem cost_problem() {
    BundleProblem problem = problem_;
    problem.burden = [this](int i, const TaskSet& tasks) { return costs_.cost(i, tasks); };
    return problem;
  }

  /// dssa and scout: messages over the simulated radio.
  Allocation negotiated(bool scout) {
    if (scout && problem_.robots > auction::PlanGossip::kMostRobots)
      throw InputError(fmt::format("scout: {} robots; the protocol can take {} at most", problem_.robots,
                                   auction::PlanGossip::kMostRobots));
    const BundleProblem durations = cost_problem();
    const Allocation initial = initial_allocation(mission_, problem_, settings_);
    NegotiationSettings radio = settings_.radio;
    radio.seed = settings_.seed;
    const auto make = [&](RobotId i) -> std::unique_ptr<auction::Negotiator> {
      if (scout)
        return std::make_unique<auction::PlanGossip>(durations, i, kRound, radio.times, settings_.seed, settings_.starts, 0.0);
      return std::make_unique<auction::HandOver>(problem_, i, kRound, initial, radio.times, settings_.seed, 0.0);
    };
    NegotiationResult run = negotiate(problem_.robots, make, radio);
    result_.agreed = run.agreed;
    result_.negotiation_s = run.duration_s;
    result_.modifications = run.modifications;
    result_.iterations = *std::max_element(run.modifications.begin(), run.modifications.end());
    result_.messages = run.radio.sent;
    for (const auto& point : run.history) {
      AllocationStep step{point.t, owners_of(point.tasks, problem_.tasks), 0.0, {}, 0};
      Allocation once = auction::empty_allocation(problem_);  // a task on its way may be seen twice
      for (std::size_t g = 0; g < step.owners.size(); ++g)
        if (step.owners[g] >= 0) once[static_cast<std::size_t>(step.owners[g])].insert(static_cast<int>(g));
      step.value = value_of(once);
      result_.steps.push_back(std::move(step));
    }
    return run.allocation;
  }

  void finish(const Allocation& allocation) {
    for (int i = 0; i < problem_.robots; ++i) {
      const TaskSet& mine = allocation[static_cast<std::size_t>(i)];
      result_.order.push_back(costs_.order(i, mine));
      result_.mission_s.push_back(costs_.cost(i, mine));
    }
    total(allocation);
  }

  void total(const Allocation& allocation) {
    for (int i = 0; i < problem_.robots; ++i) {
      const double mine = result_.mission_s[static_cast<std::size_t>(i)];
      result_.duration = std::max(result_.duration, mine);
      result_.movement += mine * costs_.speed(i);
    }
    result_.value = value_of(allocation);
    result_.undone = auction::unallocated(allocation, problem_.tasks).members();
    result_.policy_solves = costs_.solves();
  }

  const decision::TopoMission& mission_;
  TeamCosts& costs_;
  const AllocationSettings& settings_;
  BundleProblem problem_;
  AllocationResult result_;
};

}  // namespace

std::string_view to_string(Protocol protocol) {
  constexpr std::array<std::string_view, 5> kNames{"continuous", "ssa", "dssa", "optimal", "scout"};
  return kNames[static_cast<std::size_t>(protocol)];
}
std::string_view to_string(Initial initial) {
  constexpr std::array<std::string_view, 4> kNames{"empty", "random", "current", "nearest"};
  return kNames[static_cast<std::size_t>(initial)];
}
std::string_view to_string(Gains gains) { return gains == Gains::kSum ? "sum" : "makespan"; }

BundleProblem bundle_problem(TeamCosts& costs, const AllocationSettings& settings) {
  const auction::Burden cost = [&costs](int i, const TaskSet& tasks) { return costs.cost(i, tasks); };
  const double unit = std::max(costs.diameter(), 1e-9);
  BundleProblem problem{costs.robots(), costs.tasks(), {}, kRounding * unit};
  problem.burden = settings.gains == Gains::kMakespan
                       ? auction::power_mean(cost, unit)
                       : auction::altruistic(cost, settings.noc * unit, static_cast<double>(costs.tasks()) / costs.robots());
  return problem;
}

Allocation initial_allocation(const decision::TopoMission& mission, const BundleProblem& problem,
                              const AllocationSettings& settings) {
  switch (settings.initial) {
    case Initial::kRandom: return auction::random_allocation(problem, settings.seed);
    case Initial::kNearest: return auction::nearest_allocation(problem);
    case Initial::kCurrent: {
      Allocation allocation = auction::empty_allocation(problem);
      for (std::size_t i = 0; i < allocation.size(); ++i)
        for (const int g : mission.robots[i].current) allocation[i].insert(g);
      return allocation;
    }
    case Initial::kEmpty: break;
  }
  return auction::empty_allocation(problem);
}

AllocationResult allocate(const decision::TopoMission& mission, TeamCosts& costs, const AllocationSettings& settings) {
  return Run(mission, costs, settings).run();
}

}  // namespace outrider::explorer
