#include <gtest/gtest.h>

#include <string>

#include "random_world.hpp"
#include "sim/simulator.hpp"
#include "support/ascii.hpp"
#include "world/error.hpp"

namespace outrider::sim {
namespace {

RobotSpec robot(std::string name, double x, double y, double radius = 0.4, double speed = 1.0) {
  RobotSpec spec;
  spec.name = std::move(name);
  spec.start = {x, y, 0.0};
  spec.radius = radius;
  spec.speed = speed;
  return spec;
}

OccupancyGrid empty_map(int width, int height, double resolution) {
  return OccupancyGrid(GridGeometry{resolution, {}, width, height}, CellState::kFree);
}

void follow(Simulator& sim, RobotId id, std::vector<Point> way) { sim.body(id).follow(way); }

void run(Simulator& sim, int steps) {
  for (int i = 0; i < steps; ++i) sim.step();
}

std::string error_of(const OccupancyGrid& map, std::vector<RobotSpec> team, SimOptions options = {}) {
  try {
    Simulator sim(map, std::move(team), options);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Motion, SpeedIsExactWhateverTheStep) {
  for (const double resolution : {0.05, 1.0})
    for (const double dt : {0.01, 0.1, 0.3, 1.0}) {
      SCOPED_TRACE(testing::Message() << resolution << ' ' << dt);
      const OccupancyGrid map =
          empty_map(static_cast<int>(100 / resolution), static_cast<int>(4 / resolution), resolution);
      RobotSpec spec = robot("a", 1.0, 2.0, 0.4, 3.7);
      spec.range = 2.0 * resolution;
      Simulator sim(map, {spec}, {.dt = dt});
      follow(sim, 0, {{99.0, 2.0}});
      const int steps = static_cast<int>(std::floor(20.0 / dt));
      run(sim, steps);
      EXPECT_NEAR(sim.now(), steps * dt, 1e-9);
      EXPECT_NEAR(sim.path_m(0), 3.7 * steps * dt, 1e-8);
      EXPECT_NEAR(sim.pose(0).x, 1.0 + 3.7 * steps * dt, 1e-8);
      EXPECT_FALSE(sim.body(0).sense().arrived);
      EXPECT_FALSE(sim.body(0).sense().blocked);
    }
}

TEST(Motion, ManyShortSegmentsInOneStep) {
  Simulator sim(empty_map(200, 40, 0.05), {robot("a", 1.0, 1.0, 0.2, 2.0)}, {.dt = 1.0});
  std::vector<Point> stairs;  // 0.1 m a segment, right and up in turn
  for (int i = 1; i <= 8; ++i) {
    stairs.push_back({1.0 + 0.1 * i, 1.0 + 0.1 * (i - 1)});
    stairs.push_back({1.0 + 0.1 * i, 1.0 + 0.1 * i});
  }
  follow(sim, 0, stairs);
  sim.step();
  EXPECT_NEAR(sim.path_m(0), 1.6, 1e-9);
  EXPECT_EQ(sim.pose(0).position(), stairs.back());
  EXPECT_NEAR(sim.pose(0).theta, kPi / 2, 1e-12);
  EXPECT_TRUE(sim.body(0).sense().arrived);
  run(sim, 3);
  EXPECT_NEAR(sim.path_m(0), 1.6, 1e-9);
}

TEST(Motion, ANewPathReplacesTheOldOneAndAnEmptyOneStops) {
  Simulator sim(empty_map(20, 20, 1.0), {robot("a", 2.0, 2.0)}, {.dt = 0.5});
  follow(sim, 0, {{10.0, 2.0}});
  run(sim, 4);
  EXPECT_NEAR(sim.pose(0).x, 4.0, 1e-9);
  follow(sim, 0, {{4.0, 9.0}});
  run(sim, 2);
  EXPECT_NEAR(sim.pose(0).x, 4.0, 1e-9);
  EXPECT_NEAR(sim.pose(0).y, 3.0, 1e-9);
  follow(sim, 0, {});
  run(sim, 2);
  EXPECT_NEAR(sim.pose(0).y, 3.0, 1e-9);
  EXPECT_TRUE(sim.body(0).sense().arrived);
}

TEST(Motion, HeadOnRobotsStopTouching) {
  for (const double dt : {0.1, 0.7, 100.0}) {
    SCOPED_TRACE(dt);
    Simulator sim(empty_map(20, 3, 1.0), {robot("a", 1.5, 1.5), robot("b", 18.5, 1.5, 0.3, 2.0)}, {.dt = dt});
    follow(sim, 0, {{18.5, 1.5}});
    follow(sim, 1, {{1.5, 1.5}});
    run(sim, static_cast<int>(40 / dt) + 2);
    EXPECT_NEAR(distance(sim.pose(0).position(), sim.pose(1).position()), 0.7, 1e-8);
    EXPECT_TRUE(sim.body(0).sense().blocked);
    EXPECT_TRUE(sim.body(1).sense().blocked);
    EXPECT_FALSE(sim.body(0).sense().arrived);
    follow(sim, 0, {{1.5, 1.5}});  // makes way
    run(sim, static_cast<int>(2 / dt) + 1);
    EXPECT_FALSE(sim.body(0).sense().blocked);
    EXPECT_LT(sim.pose(0).x, 6.0);
  }
}

TEST(Motion, ABlockedRobotGoesOnWhenTheWayIsFree) {
  Simulator sim(empty_map(20, 9, 1.0), {robot("a", 1.5, 4.5), robot("b", 6.5, 4.5)}, {.dt = 0.1});
  follow(sim, 0, {{15.5, 4.5}});
  run(sim, 60);
  EXPECT_NEAR(sim.pose(0).x, 5.7, 1e-8);
  follow(sim, 1, {{6.5, 7.5}});
  run(sim, 130);
  EXPECT_TRUE(sim.body(0).sense().arrived);
  EXPECT_NEAR(sim.path_m(0), 14.0, 1e-6);
}

TEST(Motion, WallsStopARobotAtContact) {
  const OccupancyGrid map = test::grid_from_ascii(R"(
    ....#....
    ....#....
    ....#....)");
  Simulator sim(map, {robot("a", 1.0, 1.5, 0.3)}, {.dt = 0.25});
  follow(sim, 0, {{8.0, 1.5}, {8.0, 0.5}});
  run(sim, 60);
  EXPECT_NEAR(sim.pose(0).x, 3.7, 1e-8);
  const Sensing& sensing = sim.body(0).sense();
  EXPECT_TRUE(sensing.blocked);
  EXPECT_FALSE(sensing.arrived);
}

/// Way-points without regard to walls, team-mates or the edge of the map: the simulator's own check never fires, and
/// neither does a search that shares no code with it.
TEST(Motion, NoCommandMovesABodyIntoAWallOrATeamMate) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const double resolution = seed % 3 == 0 ? 0.1 : seed % 3 == 1 ? 0.3 : 1.0, size = 24 * resolution;
    const OccupancyGrid map = random_map(24, 24, resolution, 0.04, random);
    const Point corner = map.geometry().origin;
    const auto anywhere = [&] {
      return Point{corner.x + uniform(random, -2 * resolution, size + 2 * resolution),
                   corner.y + uniform(random, -2 * resolution, size + 2 * resolution)};
    };
    std::vector<RobotSpec> team;
    for (int tries = 0; tries < 2000 && team.size() < 6; ++tries) {
      const Point p = anywhere();
      RobotSpec spec = robot(std::to_string(team.size()), p.x, p.y, uniform(random, 0.2, 1.2) * resolution,
                             uniform(random, 0.2, 30.0) * resolution);
      spec.range = 3.0 * resolution;
      bool fits = clearance_by_search(map, p) >= spec.radius;
      for (const RobotSpec& other : team)
        fits = fits && distance(other.start.position(), p) >= other.radius + spec.radius;
      if (fits) team.push_back(spec);
    }
    Simulator sim(map, team, {.dt = 0.1});
    for (int step = 0; step < 250; ++step) {
      for (std::size_t id = 0; id < team.size(); ++id) {
        if (random() % 10 != 0) continue;
        std::vector<Point> way;
        for (std::uint64_t i = random() % 5; i > 0; --i) way.push_back(anywhere());
        if (random() % 2 == 0)  // centres of cells are what planners send
          for (Point& p : way) p = map.geometry().center(map.geometry().cell_of(p));
        follow(sim, static_cast<RobotId>(id), way);
      }
      ASSERT_NO_THROW(sim.step());
      for (std::size_t i = 0; i < team.size(); ++i) {
        const Point p = sim.pose(static_cast<RobotId>(i)).position();
        ASSERT_GE(clearance_by_search(map, p), team[i].radius - 1e-9) << i << " at step " << step;
        for (std::size_t j = 0; j < i; ++j)
          ASSERT_GE(distance(p, sim.pose(static_cast<RobotId>(j)).position()), team[i].radius + team[j].radius - 1e-9);
      }
    }
  }
}

TEST(Faults, AKilledRobotStaysAsATeamMateInTheWay) {
  Simulator sim(empty_map(20, 3, 1.0), {robot("a", 1.5, 1.5), robot("b", 6.5, 1.5)}, {.dt = 0.1});
  follow(sim, 1, {{18.5, 1.5}});
  run(sim, 10);
  sim.kill(1);
  EXPECT_FALSE(sim.alive(1));
  (void)sim.body(1).sense();
  follow(sim, 1, {{18.5, 1.5}});
  follow(sim, 0, {{18.5, 1.5}});
  run(sim, 100);
  EXPECT_NEAR(sim.pose(1).x, 7.5, 1e-9);
  EXPECT_NEAR(sim.pose(0).x, 6.7, 1e-8);
  const Sensing& dead = sim.body(1).sense();
  EXPECT_TRUE(dead.cells.empty());
  EXPECT_TRUE(dead.sightings.empty());
  ASSERT_EQ(sim.body(0).sense().sightings.size(), 1U);
  EXPECT_EQ(sim.body(0).sense().sightings[0].robot, 1);

  sim.revive(1);
  run(sim, 5);
  EXPECT_NEAR(sim.pose(1).x, 7.5, 1e-9) << "moved without being told";
  follow(sim, 1, {{9.5, 1.5}});
  run(sim, 40);
  EXPECT_NEAR(sim.pose(1).x, 9.5, 1e-9);
}

TEST(Faults, SpeedFactorScalesTheOwnSpeed) {
  Simulator sim(empty_map(20, 3, 1.0), {robot("a", 1.5, 1.5)}, {.dt = 0.1});
  follow(sim, 0, {{18.5, 1.5}});
  run(sim, 20);
  sim.set_speed_factor(0, 0.25);
  run(sim, 20);
  sim.set_speed_factor(0, 1.0);
  run(sim, 20);
  EXPECT_NEAR(sim.path_m(0), 2.0 + 0.5 + 2.0, 1e-9);
  EXPECT_THROW(sim.set_speed_factor(0, -1.0), InputError);
}

TEST(Start, BadOnesAreRefusedByName) {
  const OccupancyGrid map = test::grid_from_ascii(R"(
    ......
    ..#...
    ...?..)");
  EXPECT_EQ(error_of(map, {robot("ok", 0.5, 0.5), robot("far", 4.5, 1.5)}), "");
  EXPECT_NE(error_of(map, {robot("ok", 0.5, 0.5), robot("stuck", 2.5, 1.5)}).find("'stuck' at (2.5, 1.5)"),
            std::string::npos);
  EXPECT_NE(error_of(map, {robot("close", 3.2, 1.5)}).find("in a wall"), std::string::npos);
  EXPECT_NE(error_of(map, {robot("unknown", 3.5, 0.5)}).find("in a wall"), std::string::npos);
  EXPECT_NE(error_of(map, {robot("gone", -3.0, 1.5)}).find("'gone' at (-3, 1.5)"), std::string::npos);
  EXPECT_NE(error_of(map, {robot("gone", -3.0, 1.5)}).find("off the map"), std::string::npos);
  const std::string overlap = error_of(map, {robot("left", 0.5, 2.5), robot("right", 1.2, 2.5)});
  EXPECT_NE(overlap.find("'left'"), std::string::npos);
  EXPECT_NE(overlap.find("'right'"), std::string::npos);
  EXPECT_EQ(error_of(map, {robot("left", 0.5, 2.5), robot("right", 1.3, 2.5)}), "") << "touching is legal";
  EXPECT_NE(error_of(map, {robot("nan", std::nan(""), 1.5)}).find("'nan', start x"), std::string::npos);
  EXPECT_NE(error_of(map, {robot("point", 0.5, 0.5, 0.0)}).find("radius"), std::string::npos);
  EXPECT_NE(error_of(map, {robot("back", 0.5, 0.5, 0.4, -1.0)}).find("speed"), std::string::npos);
  EXPECT_NE(error_of(map, {robot("a", 0.5, 0.5)}, {.dt = 0.0}).find("time step"), std::string::npos);
}

}  // namespace
}  // namespace outrider::sim
