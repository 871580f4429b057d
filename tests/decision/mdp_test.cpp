#include "decision/mdp.hpp"

#include <gtest/gtest.h>

#include <random>

#include "decision/grid_mdp.hpp"
#include "decision/grid_values.hpp"
#include "decision/wavefront.hpp"
#include "support/ascii.hpp"
#include "support/random_map.hpp"

namespace outrider::decision {
namespace {

using test::cell_marked;
using test::grid_from_ascii;

// Two states: stay for 1 a step, or leave for a terminal worth 5. V = max(1 / (1 - gamma), gamma 5).
TEST(ValueIteration, SolvesATwoStateProcessByHand) {
  for (const double gamma : {0.5, 0.9}) {
    SCOPED_TRACE(gamma);
    GraphMdp model(2);
    model.choices[0] = {{1.0, gamma, {{0, 1.0}}}, {0.0, gamma, {{1, 1.0}}}};
    model.terminals[1] = 5.0;
    const Solution solution = ValueIteration{.tolerance = 1e-12}(model);
    const double stay = 1.0 / (1.0 - gamma), leave = gamma * 5.0;
    EXPECT_NEAR(solution.values[0], std::max(stay, leave), 1e-9);
    EXPECT_EQ(solution.policy[0], stay > leave ? 0 : 1);
    EXPECT_EQ(solution.policy[1], kNoAction);
    EXPECT_TRUE(solution.converged);
  }
}

TEST(ValueIteration, TheBoundHoldsAfterEverySweep) {
  GraphMdp model(3);
  model.choices[0] = {{1.0, 0.9, {{0, 0.5}, {1, 0.5}}}};
  model.choices[1] = {{0.0, 0.9, {{0, 0.7}, {2, 0.3}}}, {0.4, 0.8, {{1, 1.0}}}};
  model.terminals[2] = 3.0;
  const Solution exact = ValueIteration{.tolerance = 1e-13}(model);
  for (int sweeps = 1; sweeps < 40; ++sweeps) {
    const Solution rough = ValueIteration{.most_sweeps = sweeps}(model);
    EXPECT_FALSE(rough.converged);
    for (State s = 0; s < 3; ++s) EXPECT_LE(std::abs(rough.values[s] - exact.values[s]), rough.bound + 1e-12);
  }
}

TEST(ValueIteration, InPlaceAndFromAnyStartItFindsTheSameValues) {
  const auto mask = test::free_cells(test::random_map(5, 20));
  const std::vector<Goal> goals{{mask.geometry().cell_at(7), 1.0}, {mask.geometry().cell_at(60), 0.7}};
  const GridMdp model(mask, goals, 0.9, {.ahead = 0.8});
  const Solution jacobi = ValueIteration{.tolerance = 1e-12}(model);
  const Solution seidel = ValueIteration{.tolerance = 1e-12, .in_place = true}(model);
  const Solution high = ValueIteration{.tolerance = 1e-12}(model, std::vector<double>(model.states(), 2.0));
  EXPECT_LT(seidel.sweeps, jacobi.sweeps);
  for (State s = 0; s < model.states(); ++s) {
    EXPECT_NEAR(jacobi.values[s], seidel.values[s], 1e-9);
    EXPECT_NEAR(jacobi.values[s], high.values[s], 1e-9);
  }
}

std::vector<Goal> random_goals(const GridGeometry& g, std::mt19937_64& random) {
  std::vector<Goal> goals;
  for (auto n = random() % 5; n > 0; --n)
    goals.push_back({g.cell_at(random() % g.size()), 0.05 + 0.1 * static_cast<double>(random() % 12)});
  return goals;
}

// Goals are rounded to a 70th of a cell, which shows in the last digits.
TEST(Wavefront, IsTheSolutionForDeterministicMotion) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto mask = test::free_cells(test::random_map(seed, 24, 0.5));
    const auto goals = random_goals(mask.geometry(), random);
    Wavefront front;
    front.compute(mask, goals, 0.8);
    const Solution oracle = ValueIteration{.tolerance = 1e-13}(GridMdp(mask, goals, 0.8, {}));
    for (std::size_t i = 0; i < mask.size(); ++i) {
      const Cell c = mask.geometry().cell_at(i);
      ASSERT_NEAR(front.value(c), oracle.values[i], 1e-9 + 1e-3 * oracle.values[i]) << "cell " << i;
      const auto way = front.path(c);
      ASSERT_EQ(way.empty(), oracle.values[i] <= 1e-9);
    }
  }
}

TEST(Wavefront, RepairedItEqualsOneFromScratch) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    auto mask = test::free_cells(test::random_map(seed, 30));
    auto goals = random_goals(mask.geometry(), random);
    Wavefront repaired, fresh;
    repaired.compute(mask, goals, 0.9);
    for (int change = 0; change < 12; ++change) {
      std::vector<std::uint32_t> changed;
      for (auto n = random() % 12; n > 0; --n) {
        changed.push_back(static_cast<std::uint32_t>(random() % mask.size()));
        mask[changed.back()] = random() % 2;
      }
      if (random() % 2 == 0) goals = random_goals(mask.geometry(), random);
      repaired.update(mask, changed, goals);
      fresh.compute(mask, goals, 0.9);
      for (std::size_t i = 0; i < mask.size(); ++i)
        ASSERT_EQ(repaired.level(i), fresh.level(i)) << "change " << change << ", cell " << i;
    }
  }
}

TEST(Wavefront, GoesToTheFartherGoalWhenItIsWorthIt) {
  constexpr const char* kMap = R"(
    #############
    #a..s......b#
    #############)";
  const auto map = grid_from_ascii(kMap);
  Wavefront front;
  for (const double near_value : {1.0, 0.1}) {
    SCOPED_TRACE(near_value);
    const std::vector<Goal> goals{{cell_marked(kMap, 'a'), near_value}, {cell_marked(kMap, 'b'), 1.0}};
    front.compute(test::free_cells(map), goals, 0.8);
    const auto way = front.path(cell_marked(kMap, 's'));
    ASSERT_FALSE(way.empty());
    EXPECT_EQ(way.back(), cell_marked(kMap, near_value == 1.0 ? 'a' : 'b'));
  }
}

void expect_values_near(const GridValues& fast, const GridMdp& model, double relative) {
  const Solution oracle = ValueIteration{.tolerance = 1e-13}(model);
  for (State s = 0; s < model.states(); ++s)
    ASSERT_NEAR(fast.values()[s], oracle.values[s], 1e-10 + relative * oracle.values[s]) << "state " << s;
}

TEST(GridValues, AgreesWithJacobiColdAndAfterChanges) {
  for (std::uint64_t seed = 1; seed <= 15; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    auto mask = test::free_cells(test::random_map(seed, 18));
    auto goals = random_goals(mask.geometry(), random);
    const Motion motion{.ahead = seed % 2 == 0 ? 0.8 : 0.6};
    GridValues values;
    values.tolerance = 1e-6;
    Wavefront front;
    for (int change = 0; change < 5; ++change) {
      const GridMdp model(mask, goals, 0.9, motion);
      front.compute(mask, goals, 0.9);
      values.solve(model, front);
      expect_values_near(values, model, 2e-4);
      for (auto n = random() % 6; n > 0; --n) mask[random() % mask.size()] = random() % 2;
      if (random() % 2 == 0) goals = random_goals(mask.geometry(), random);
    }
  }
}

TEST(GridValues, StrayingCostsAndTheWayStillLeadsToTheGoal) {
  constexpr const char* kMap = R"(
    ###########
    #.........#
    #.#######.#
    #.#######.#
    #s.......g#
    ###########)";
  const auto mask = test::free_cells(grid_from_ascii(kMap));
  const std::vector<Goal> goals{{cell_marked(kMap, 'g'), 1.0}};
  const GridMdp model(mask, goals, 0.9, {.ahead = 0.8});
  Wavefront front;
  front.compute(mask, goals, 0.9);
  GridValues values;
  values.solve(model, front);
  const Cell start = cell_marked(kMap, 's');
  EXPECT_LT(values.value(start), front.value(start));
  EXPECT_EQ(values.path(model, start).back(), cell_marked(kMap, 'g'));
  GridValues sure;
  const GridMdp certain(mask, goals, 0.9, {});
  sure.solve(certain, front);
  EXPECT_NEAR(sure.value(start), front.value(start), 1e-4);
}

}  // namespace
}  // namespace outrider::decision
