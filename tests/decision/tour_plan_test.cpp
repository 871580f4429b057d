#include "decision/tour_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <random>

#include "decision/passability.hpp"
#include "support/ascii.hpp"

namespace outrider::decision {
namespace {

HopedWorld world_of(const OccupancyGrid& map, int block, Cell at) {
  HopedWorld world(map.geometry(), block, 1);
  world.update(map, passable_mask(map, 0.1));
  world.look_from(at);
  return world;
}

int count(const HopedWorld::Picture& picture) {
  int n = 0;
  for (const std::uint64_t tile : picture) n += std::popcount(tile);
  return n;
}

constexpr const char* kWalled = R"(
  ....????
  ....????
  ########
  .a..????
  ....????
)";

TEST(HopedWorld, HopesWhereAWayMayLeadAndNextToWhatIsFree) {
  const OccupancyGrid map = test::grid_from_ascii(kWalled);
  const Cell at = test::cells_marked(kWalled, 'a')[0];
  const HopedWorld world = world_of(map, 2, at);
  // Below the wall everything unknown; above it only what touches known free cells.
  EXPECT_EQ(count(world.unseen()), 8 + 2);
  EXPECT_NE(world.node_at({7, 0}), HopedWorld::kNone);
  EXPECT_TRUE(world.reachable(world.node_at({7, 0})));
  EXPECT_FALSE(world.reachable(world.node_at({7, 4})));
}

TEST(HopedWorld, AWallDividesABlock) {
  const OccupancyGrid map = test::grid_from_ascii("..#..\n..#..\n..#..\n..#..\n.....");
  const HopedWorld world = world_of(map, 5, {0, 4});
  EXPECT_EQ(world.node_at({0, 4}), world.node_at({4, 4}));  // joined below
  const OccupancyGrid closed = test::grid_from_ascii("..#..\n..#..\n..#..\n..#..\n..#..");
  const HopedWorld two = world_of(closed, 5, {0, 4});
  EXPECT_NE(two.node_at({0, 4}), two.node_at({4, 4}));
  EXPECT_FALSE(two.reachable(two.node_at({4, 4})));
}

TEST(HopedWorld, FollowsAMapAsIfItHadSeenItAtOnce) {
  for (std::uint32_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    OccupancyGrid map(GridGeometry{1.0, {0.0, 0.0}, 40, 30});
    HopedWorld growing(map.geometry(), 3, 1);
    for (int k = 0; k < 6; ++k) {
      for (int i = 0; i < 200; ++i)
        map[random() % map.size()] = random() % 4 == 0 ? CellState::kOccupied : CellState::kFree;
      growing.update(map, passable_mask(map, 0.1));
    }
    HopedWorld fresh(map.geometry(), 3, 1);
    fresh.update(map, passable_mask(map, 0.1));
    const Cell at{static_cast<int>(random() % 40), static_cast<int>(random() % 30)};
    growing.look_from(at);
    fresh.look_from(at);
    EXPECT_EQ(growing.unseen(), fresh.unseen());
    for (std::size_t i = 0; i < map.size(); ++i) {
      const Cell c = map.geometry().cell_at(i);
      ASSERT_EQ(growing.node_at(c), fresh.node_at(c));
      const auto n = fresh.node_at(c);
      if (n != HopedWorld::kNone) {
        ASSERT_EQ(growing.edges(n).size(), fresh.edges(n).size());
      }
    }
  }
}

class Field : public testing::Test {
 protected:
  Field() : map_(GridGeometry{1.0, {0.0, 0.0}, 40, 40}) {
    for (int y = 0; y < 40; ++y)
      for (int x = 0; x < 40; ++x)
        if (x % 7 == 3 && y % 5 != 0) map_[Cell{x, y}] = CellState::kOccupied;
    map_[Cell{0, 0}] = map_[Cell{38, 38}] = CellState::kFree;
    world_ = world_of(map_, 2, {0, 0});
  }

  std::vector<Tourist> team() {
    return {{world_.node_at({0, 0}), 2.0, world_.range_class(4.0), false},
            {world_.node_at({38, 38}), 3.0, world_.range_class(6.0), false}};
  }

  OccupancyGrid map_;
  HopedWorld world_{map_.geometry(), 2, 1};
};

TEST_F(Field, CompleteToursLeaveNothingThatCanBeSeen) {
  TourPlanner planner(world_, {.most_stops = 1000});
  planner.begin(team());
  Tours tours(2);
  const int before = planner.left_after(tours);
  planner.complete(tours);
  EXPECT_GT(before, 500);
  EXPECT_EQ(planner.left_after(tours), 0);
  for (const auto& tour : tours)
    for (const auto n : tour) EXPECT_TRUE(world_.reachable(n));
}

TEST_F(Field, PruningLosesNothingAndKeepsFixedStops) {
  TourPlanner planner(world_, {.most_stops = 1000});
  auto robots = team();
  robots[1].first_fixed = true;
  planner.begin(robots);
  Tours tours{{}, {world_.node_at({37, 36})}};
  planner.complete(tours);
  tours[0].insert(tours[0].end(), {tours[0][0], tours[0][1]});  // the way back shows nothing new
  const int before = planner.left_after(tours);
  const std::size_t stops = tours[0].size();
  planner.prune(tours);
  EXPECT_LE(planner.left_after(tours), before);
  EXPECT_LT(tours[0].size(), stops);
  EXPECT_EQ(tours[1][0], world_.node_at({37, 36}));
}

TEST_F(Field, PlansTheSameFromTheSame) {
  Tours first(2), second(2);
  for (Tours* tours : {&first, &second}) {
    TourPlanner planner(world_, {.most_stops = 20});
    planner.begin(team());
    planner.complete(*tours);
  }
  EXPECT_EQ(first, second);
}

TEST_F(Field, LegsLeadThereAlongEdgesAndAreNoShorterThanTheCrowFlies) {
  TourPlanner planner(world_, {});
  planner.begin(team());
  const auto from = world_.node_at({0, 0}), to = world_.node_at({38, 20});
  const auto& leg = planner.leg(from, to);
  ASSERT_FALSE(leg.nodes.empty());
  EXPECT_EQ(leg.nodes.back(), to);
  auto at = from;
  for (const auto n : leg.nodes) {
    const auto edges = world_.edges(at);
    EXPECT_TRUE(std::any_of(edges.begin(), edges.end(), [&](const auto& e) { return e.to == n; }));
    at = n;
  }
  EXPECT_GE(leg.metres.back(), world_.straight_m(from, to) - 1e-3);
  EXPECT_TRUE(planner.leg(from, from).nodes.empty());
}

}  // namespace
}  // namespace outrider::decision
