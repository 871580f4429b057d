// The protocols on topological maps: every one keeps the same laws, and the optimum bounds them all.

#include "explorer/allocation_run.hpp"

#include <gtest/gtest.h>

#include <set>

#include "explorer/mission_draw.hpp"
#include "support/topo_maps.hpp"
#include "world/error.hpp"

namespace outrider::explorer {
namespace {

constexpr Protocol kAll[] = {Protocol::kContinuous, Protocol::kSsa, Protocol::kDssa, Protocol::kOptimal, Protocol::kScout};

void expect_sound(const decision::TopoMission& mission, const AllocationResult& result) {
  std::set<int> done;
  for (const auto& order : result.order)
    for (const int g : order) EXPECT_TRUE(done.insert(g).second) << "goal " << g << " twice";
  EXPECT_EQ(done.size() + result.undone.size(), mission.goals.size());
  double longest = 0.0;
  for (const double s : result.mission_s) longest = std::max(longest, s);
  EXPECT_EQ(result.duration, longest);
  EXPECT_TRUE(result.agreed);
}

TEST(Allocate, EveryProtocolDoesEveryGoalOnceAndNoneBeatsTheOptimum) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed)
    for (const bool home : {false, true}) {
      SCOPED_TRACE(testing::Message() << "seed " << seed << ", home " << home);
      const auto mission = draw_mission(test::random_streets(6, 0.3, seed % 3 ? 0.0 : 0.1, seed), 7, 3,
                                        seed % 2 ? Starts::kApart : Starts::kTogether, seed);
      TeamCosts costs(mission, home);
      double value = 0.0, makespan = 0.0;
      AllocationSettings s{.return_home = home, .seed = seed};
      s.protocol = Protocol::kOptimal;
      value = allocate(mission, costs, s).value;
      s.gains = Gains::kMakespan;
      makespan = allocate(mission, costs, s).duration;
      s.gains = Gains::kSum;
      for (const Protocol protocol : kAll) {
        SCOPED_TRACE(to_string(protocol));
        s.protocol = protocol;
        const auto result = allocate(mission, costs, s);
        expect_sound(mission, result);
        EXPECT_LE(result.value, value + 1e-3);
        EXPECT_GE(result.duration, makespan - 1e-3);
        const auto again = allocate(mission, costs, s);
        EXPECT_EQ(again.order, result.order);
        EXPECT_EQ(again.messages, result.messages);
      }
    }
}

TEST(Allocate, TheOrderCostsWhatThePlannerSays) {
  const auto mission = draw_mission(test::random_streets(6, 0.3, 0.0, 4), 9, 3, Starts::kApart, 4);
  TeamCosts costs(mission, true);
  AllocationSettings s{.return_home = true, .seed = 4};
  for (const Protocol protocol : kAll) {
    s.protocol = protocol;
    const auto result = allocate(mission, costs, s);
    for (int i = 0; i < 3; ++i) {
      double driven = 0.0;
      int at = -1;
      for (const int g : result.order[static_cast<std::size_t>(i)]) driven += costs.leg(i, at, g), at = g;
      EXPECT_NEAR(driven + costs.home(i, at), result.mission_s[static_cast<std::size_t>(i)], 1e-3) << to_string(protocol);
    }
  }
}

TEST(Allocate, UnlikeRobotsFasterOnesDoMore) {
  auto mission = draw_mission(test::random_streets(7, 0.2, 0.0, 2), 12, 2, Starts::kTogether, 2);
  mission.robots[1].speed = 4.0;
  TeamCosts costs(mission, false);
  const auto result = allocate(mission, costs, {.protocol = Protocol::kScout, .seed = 2});
  EXPECT_GT(result.order[1].size(), 2 * result.order[0].size());
}

TEST(Allocate, ARobotIsNeverGivenWhatItsOwnMapDoesNotShow) {
  auto mission = draw_mission(test::random_streets(4, 0.0, 0.0, 1), 5, 2, Starts::kApart, 3);
  auto own = std::make_shared<decision::TopologicalMap>(mission.map);
  const int hidden = mission.goals[2];
  own->waypoints[static_cast<std::size_t>(hidden)].id = "elsewhere";
  mission.robots[0].own = own;
  TeamCosts costs(mission, false);
  for (const Protocol protocol : kAll) {
    const auto result = allocate(mission, costs, {.protocol = protocol, .seed = 1});
    expect_sound(mission, result);
    EXPECT_TRUE(result.undone.empty());
    for (const int g : result.order[0]) EXPECT_NE(g, 2) << to_string(protocol);
  }
}

TEST(Allocate, TheCurrentAllocationIsABeginning) {
  auto mission = draw_mission(test::random_streets(6, 0.3, 0.0, 9), 6, 2, Starts::kApart, 9);
  TeamCosts costs(mission, false);
  AllocationSettings s{.protocol = Protocol::kSsa, .seed = 9};
  const auto first = allocate(mission, costs, s);
  for (std::size_t i = 0; i < 2; ++i) mission.robots[i].current = first.order[i];
  s.initial = Initial::kCurrent;
  const auto again = allocate(mission, costs, s);
  EXPECT_EQ(again.iterations, 1);
  EXPECT_EQ(again.order, first.order);
}

TEST(Allocate, SixtyGoalsAreWithinTheBound) {
  const auto mission = draw_mission(test::random_streets(11, 0.2, 0.0, 5), 60, 3, Starts::kApart, 5);
  TeamCosts costs(mission, false);
  const auto result = allocate(mission, costs, {.protocol = Protocol::kSsa, .seed = 5});
  expect_sound(mission, result);
  for (int i = 0; i < 3; ++i) {
    TaskSet mine;
    for (const int g : result.order[static_cast<std::size_t>(i)]) mine.insert(g);
    EXPECT_LE(costs.lower_bound(i, mine), costs.cost(i, mine) + 1e-3);
  }
}

TEST(Allocate, TooManyGoalsForEnumerationIsAnErrorThatSaysSo) {
  const auto mission = draw_mission(test::random_streets(6, 0.3, 0.0, 1), 17, 2, Starts::kApart, 1);
  TeamCosts costs(mission, false);
  EXPECT_THROW(allocate(mission, costs, {.protocol = Protocol::kOptimal}), InputError);
}

TEST(DrawMission, IsDeterministicAndNeverStartsOnAGoal) {
  const auto map = test::random_streets(5, 0.3, 0.0, 1);
  for (const Starts starts : {Starts::kApart, Starts::kTogether}) {
    const auto a = draw_mission(map, 10, 4, starts, 7), b = draw_mission(map, 10, 4, starts, 7);
    EXPECT_EQ(a.goals, b.goals);
    std::set<int> goals(a.goals.begin(), a.goals.end()), places;
    EXPECT_EQ(goals.size(), 10U);
    for (const auto& r : a.robots) {
      EXPECT_FALSE(goals.contains(r.at));
      places.insert(r.at);
    }
    EXPECT_EQ(places.size(), starts == Starts::kApart ? 4U : 1U);
  }
  EXPECT_THROW(draw_mission(map, 25, 3, Starts::kApart, 1), InputError);
}

}  // namespace
}  // namespace outrider::explorer
