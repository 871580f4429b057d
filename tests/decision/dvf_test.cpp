#include "decision/dvf.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/ascii.hpp"
#include "support/random_map.hpp"

namespace outrider::decision {
namespace {

/// Eq. 2 step by step, with nothing but plain value iteration: V_emp, f_ij, Pr, then V_i.
std::vector<double> by_the_book(const Grid<std::uint8_t>& mask, const std::vector<Cell>& goals,
                                const std::vector<Rival>& rivals, const DvfReading& reading) {
  const ValueIteration iterate{.tolerance = 1e-13};
  std::vector<double> penalty(goals.size(), 0.0);
  for (const Rival& rival : rivals) {
    const Grid<std::uint8_t>& kind = rival.passable != nullptr ? *rival.passable : mask;
    std::vector<Goal> rewards;
    for (const Cell goal : goals)
      if (kind[goal]) rewards.push_back({goal, 1.0});
    const auto empathic = iterate(GridMdp(kind, rewards, reading.gamma, reading.motion)).values;
    const double f = rewards.empty() ? 0.0 : 1.0 / *std::max_element(empathic.begin(), empathic.end());
    DistanceField wave;
    const Cell source[] = {rival.at};
    wave.compute(kind, source);
    for (std::size_t k = 0; k < goals.size(); ++k)
      if (kind[goals[k]] && wave.reached(goals[k]))
        penalty[k] += f * std::exp(-wave.metres(goals[k]) / reading.reach) * empathic[mask.geometry().index(goals[k])];
  }
  std::vector<Goal> left;
  for (std::size_t k = 0; k < goals.size(); ++k)
    if (const double value = 1.0 - reading.kappa * penalty[k]; value > 0.0) left.push_back({goals[k], value});
  return iterate(GridMdp(mask, left, reading.gamma, reading.motion)).values;
}

TEST(DvfPlanner, IsEquationTwoOnRandomMaps) {
  int compared = 0;
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto mask = test::free_cells(test::random_map(seed, 20, 0.5));
    Grid<std::uint8_t> big_ones = mask;  // where robots of another kind fit
    std::vector<Cell> open;
    for (std::size_t i = 0; i < mask.size(); ++i) {
      if (mask[i]) open.push_back(mask.geometry().cell_at(i));
      big_ones[i] = mask[i] && random() % 8 != 0;
    }
    if (open.size() < 12) continue;
    const auto anywhere = [&] { return open[random() % open.size()]; };
    std::vector<Cell> goals;
    for (auto n = 1 + random() % 6; n > 0; --n)
      if (const Cell c = anywhere(); std::find(goals.begin(), goals.end(), c) == goals.end()) goals.push_back(c);
    std::vector<Rival> rivals;
    for (auto n = random() % 3; n > 0; --n) rivals.push_back({anywhere(), random() % 2 == 0 ? nullptr : &big_ones});
    for (Rival& rival : rivals)
      if (rival.passable != nullptr) big_ones[rival.at] = 1;
    DvfReading reading{.gamma = 0.8, .reach = 1.5};
    if (seed % 3 == 0) reading.motion.ahead = 0.8;
    DvfPlanner planner(reading);
    const auto plan = planner.plan(mask, anywhere(), goals, rivals);
    if (!plan || plan->crowded_out) continue;
    ++compared;
    const auto oracle = by_the_book(mask, goals, rivals, reading);
    for (std::size_t i = 0; i < mask.size(); ++i)
      ASSERT_NEAR(planner.value(mask.geometry().cell_at(i)), oracle[i], 2e-3 + 5e-3 * oracle[i]) << "cell " << i;
  }
  EXPECT_GT(compared, 7);
}

constexpr const char* kTwoDoors = R"(
    #####################
    #a......s..........b#
    #####################)";

TEST(DvfPlanner, LeavesANearGoalToTheRobotThatStandsThere) {
  const auto mask = test::free_cells(test::grid_from_ascii(kTwoDoors));
  const Cell a = test::cell_marked(kTwoDoors, 'a'), b = test::cell_marked(kTwoDoors, 'b');
  const std::vector<Cell> goals{a, b};
  DvfPlanner planner({});
  const Cell self = test::cell_marked(kTwoDoors, 's');
  EXPECT_EQ(planner.plan(mask, self, goals, {})->goal, a);
  const std::vector<Rival> rival{{a, nullptr}};
  const auto plan = planner.plan(mask, self, goals, rival);
  EXPECT_EQ(plan->goal, b);
  EXPECT_FALSE(plan->crowded_out);
}

TEST(DvfPlanner, ARivalRepelsFromWhereItIsHeadingWhenIntentionsCount) {
  const auto mask = test::free_cells(test::grid_from_ascii(kTwoDoors));
  const Cell a = test::cell_marked(kTwoDoors, 'a'), b = test::cell_marked(kTwoDoors, 'b');
  const Cell self = test::cell_marked(kTwoDoors, 's');
  const std::vector<Cell> goals{a, b};
  const std::vector<Rival> rival{{.at = self, .goal = a}};
  EXPECT_EQ(DvfPlanner({}).plan(mask, self, goals, rival)->goal, b);
}

TEST(DvfPlanner, CrowdedOutItFallsBackOnItsOwnValues) {
  const auto mask = test::free_cells(test::grid_from_ascii(kTwoDoors));
  const Cell a = test::cell_marked(kTwoDoors, 'a');
  const std::vector<Cell> goals{a};
  const std::vector<Rival> rival{{a, nullptr}};
  DvfPlanner planner({});
  const auto plan = planner.plan(mask, test::cell_marked(kTwoDoors, 's'), goals, rival);
  ASSERT_TRUE(plan);
  EXPECT_TRUE(plan->crowded_out);
  EXPECT_EQ(plan->goal, a);
}

TEST(DvfPlanner, NothingCanBeReachedFromAClosedRoom) {
  const auto mask = test::free_cells(test::grid_from_ascii("..#.."));
  DvfPlanner planner({});
  const std::vector<Cell> goals{{4, 0}};
  EXPECT_FALSE(planner.plan(mask, {0, 0}, goals, {}));
  EXPECT_FALSE(planner.plan(mask, {0, 0}, {}, {}));
}

// Warm, planner by planner: the answer must not depend on what was planned before.
TEST(DvfPlanner, RemembersNothingButValues) {
  std::mt19937_64 random(3);
  auto mask = test::free_cells(test::random_map(11, 30));
  DvfPlanner warm({});
  for (int round = 0; round < 20; ++round) {
    for (int k = 0; k < 5; ++k) mask[random() % mask.size()] = random() % 3 != 0;
    const auto anywhere = [&] { return mask.geometry().cell_at(random() % mask.size()); };
    std::vector<Cell> goals;
    for (int k = 0; k < 6; ++k)
      if (const Cell c = anywhere(); mask[c]) goals.push_back(c);
    const std::vector<Rival> rivals{{anywhere(), nullptr}, {anywhere(), nullptr}};
    const Cell at = anywhere();
    DvfPlanner fresh({});
    const auto a = warm.plan(mask, at, goals, rivals), b = fresh.plan(mask, at, goals, rivals);
    ASSERT_EQ(a.has_value(), b.has_value()) << "round " << round;
    if (!a) continue;
    EXPECT_EQ(a->goal, b->goal) << "round " << round;
    EXPECT_EQ(a->value, b->value) << "round " << round;
  }
}

}  // namespace
}  // namespace outrider::decision
