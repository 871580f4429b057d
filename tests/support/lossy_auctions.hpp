#pragma once
// One seeded auction over a bad radio, and what must hold afterwards: shared by the tests and the soak.

#include <fmt/format.h>

#include <string>

#include "auction/hand_over.hpp"
#include "auction/plan_gossip.hpp"
#include "explorer/negotiation.hpp"
#include "support/tour_problems.hpp"

namespace outrider::test {

struct LossyAuction {
  auction::BundleProblem problem;
  explorer::NegotiationSettings radio;
  explorer::NegotiationResult result;
  std::string wrong;  ///< the first law that it broke; empty: none
};

/// 30 % loss, random delays that reorder, repetitions, and in two of three runs a robot that dies in the middle; between
/// 2 and 5 robots, 1 to 10 tasks; odd seeds begin with a random allocation.
inline LossyAuction lossy_auction(std::uint64_t seed, bool plans = false) {
  std::mt19937_64 random(seed);
  LossyAuction run;
  const int robots = 2 + static_cast<int>(random() % 4), tasks = 1 + static_cast<int>(random() % 10);
  run.problem = random() % 4 == 0 ? unlike_problem(robots, tasks, seed) : tour_problem(robots, tasks, seed);
  run.radio.loss = 0.3;
  run.radio.delay_s = random() % 2 == 0 ? 0.1 : 0.005;
  run.radio.duplicate = 0.1;
  run.radio.seed = seed;
  const int dead = random() % 3 == 0 ? -1 : static_cast<int>(random() % static_cast<std::uint64_t>(robots));
  if (dead >= 0) run.radio.deaths = {{dead, 0.02 * static_cast<double>(random() % 100)}};
  const auction::Allocation initial =
      seed % 2 ? auction::random_allocation(run.problem, seed) : auction::empty_allocation(run.problem);
  run.result = explorer::negotiate(robots, [&](RobotId i) -> std::unique_ptr<auction::Negotiator> {
    if (plans) return std::make_unique<auction::PlanGossip>(run.problem, i, RoundId{}, run.radio.times, seed, 6, 0.0);
    return std::make_unique<auction::HandOver>(run.problem, i, RoundId{}, initial, run.radio.times, seed, 0.0);
  }, run.radio);

  const auto& allocation = run.result.allocation;
  if (!run.result.agreed) run.wrong = fmt::format("no end after {} s", run.radio.most_s);
  for (int g = 0; g < tasks && run.wrong.empty(); ++g) {
    int owners = 0;
    bool able = false;
    for (int i = 0; i < robots; ++i) {
      owners += allocation[static_cast<std::size_t>(i)].contains(g) ? 1 : 0;
      able = able || (i != dead && run.problem.burden(i, TaskSet{}.with(g)) != auction::kImpossible);
    }
    if (owners != (able ? 1 : 0)) run.wrong = fmt::format("task {} has {} living owners", g, owners);
  }
  for (int g = 0; g < tasks && run.wrong.empty() && !plans; ++g)  // locally optimal, eq. 9
    for (int i = 0; i < robots; ++i)
      for (int j = 0; j < robots; ++j)
        if (const auto &from = allocation[static_cast<std::size_t>(i)], &to = allocation[static_cast<std::size_t>(j)];
            i != j && j != dead && from.contains(g) &&
            price(run.problem, i, from, g) > price(run.problem, j, to, g) + run.problem.epsilon)
          run.wrong = fmt::format("robot {} should have handed task {} to robot {}", i, g, j);
  return run;
}

}  // namespace outrider::test
