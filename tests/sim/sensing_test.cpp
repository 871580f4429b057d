// What bodies report while they drive.

#include <gtest/gtest.h>

#include "random_world.hpp"
#include "sim/lidar.hpp"
#include "sim/simulator.hpp"
#include "sim/visibility.hpp"
#include "sim/world.hpp"
#include "support/ascii.hpp"
#include "world/ray.hpp"

namespace outrider::sim {
namespace {

RobotSpec robot(std::string name, double x, double y, double range) {
  RobotSpec spec;
  spec.name = std::move(name);
  spec.start = {x, y, 0.0};
  spec.radius = 0.3;
  spec.range = range;
  spec.speed = 4.0;
  return spec;
}

std::vector<std::uint8_t> seen_by(const std::vector<SeenCell>& cells, std::size_t size) {
  std::vector<std::uint8_t> seen(size, 0);
  for (const SeenCell& cell : cells) seen[cell.index] = 1;
  return seen;
}

TEST(Sensing, CellsAreSensedAlongTheWholeWay) {
  std::mt19937_64 random(11);
  OccupancyGrid map = random_map(40, 9, 1.0, 0.1, random);
  for (int x = 0; x < 40; ++x) map[Cell{x, 4}] = CellState::kFree;
  const Point start = map.geometry().center({2, 4}), goal = map.geometry().center({37, 4});
  std::vector<std::uint8_t> expected(map.size(), 0);
  std::vector<SeenCell> ignored;
  for (int x = 2; x <= 37; ++x) CellSensor(map, 3.0).sense({x, 4}, expected, ignored);

  for (const double dt : {0.1, 2.0, 1000.0}) {  // also many cells a step
    SCOPED_TRACE(dt);
    Simulator sim(map, {robot("a", start.x, start.y, 3.0)}, {.dt = dt});
    sim.body(0).follow(std::vector<Point>{goal});
    std::vector<SeenCell> cells = sim.body(0).sense().cells;
    EXPECT_FALSE(cells.empty()) << "at the start";
    while (!sim.body(0).sense().arrived) {
      sim.step();
      const Sensing& sensing = sim.body(0).sense();
      cells.insert(cells.end(), sensing.cells.begin(), sensing.cells.end());
    }
    EXPECT_EQ(seen_by(cells, map.size()), expected);
    EXPECT_TRUE(sim.body(0).sense().cells.empty()) << "delivered twice";
  }
}

TEST(Sensing, ADiagonalStepDoesNotSenseFromTheCellsBesideIt) {
  const OccupancyGrid map(GridGeometry{1.0, {}, 20, 20}, CellState::kFree);
  Simulator sim(map, {robot("a", 5.5, 5.5, 0.5)}, {.dt = 0.1});
  sim.body(0).follow(std::vector<Point>{{10.5, 10.5}});
  for (int i = 0; i < 30; ++i) sim.step();
  const auto& cells = sim.body(0).sense().cells;  // range 0.5: only the cells stood in
  EXPECT_EQ(cells.size(), 6U);
  for (const SeenCell& cell : cells) {
    const Cell c = map.geometry().cell_at(cell.index);
    EXPECT_EQ(c.x, c.y);
  }
}

TEST(Sensing, TeamMatesAreSightedInRangeAndInLineOfSight) {
  const OccupancyGrid map = test::grid_from_ascii(R"(
    ..........
    ...#......
    ..........)");
  Simulator sim(map,
                {robot("a", 1.5, 1.5, 5.0), robot("near", 1.5, 2.4, 5.0), robot("hidden", 5.5, 1.5, 5.0),
                 robot("far", 8.5, 0.5, 5.0)},
                {});
  const auto& sightings = sim.body(0).sense().sightings;
  ASSERT_EQ(sightings.size(), 1U);
  EXPECT_EQ(sightings[0].robot, 1);
  EXPECT_EQ(sightings[0].position, (Point{1.5, 2.4}));
  EXPECT_EQ(sightings[0].radius, 0.3);
  ASSERT_EQ(sim.body(2).sense().sightings.size(), 1U);  // the obstacle hides both of the others
  EXPECT_EQ(sim.body(2).sense().sightings[0].robot, 3);
}

TEST(Lidar, RangesAreThoseOfTheExactRay) {
  const World world = embedded_world("office");
  RobotSpec spec = robot("a", world.starts[0].x, world.starts[0].y, 6.0);
  spec.start.theta = 0.3;
  spec.fov = kPi;
  spec.beams = 181;
  Simulator sim(world.map, {spec}, {.lidar = true});
  const Sensing& sensing = sim.body(0).sense();
  EXPECT_TRUE(sensing.cells.empty());
  ASSERT_EQ(sensing.scans.size(), 1U);
  const PosedScan& posed = sensing.scans[0];
  EXPECT_EQ(posed.T_map_robot, spec.start);
  const LaserScan& scan = posed.scan;
  ASSERT_EQ(scan.ranges.size(), 181U);
  EXPECT_NEAR(scan.angle_min, -kPi / 2, 1e-12);
  EXPECT_NEAR(scan.angle(180), kPi / 2, 1e-12);
  std::size_t echoes = 0;
  for (std::size_t i = 0; i < scan.ranges.size(); ++i) {
    const auto hit = cast_ray(world.map, spec.start.position(), 0.3 + scan.angle(i), 6.0);
    EXPECT_EQ(scan.valid(i), hit.has_value());
    EXPECT_NEAR(scan.ranges[i], hit.value_or(6.0), 1e-5);
    echoes += hit.has_value();
  }
  EXPECT_GT(echoes, 20U);
  EXPECT_LT(echoes, 181U);
}

// 0.9 m is more than the nearest float.
TEST(Lidar, NothingInRangeIsNoEchoWhateverTheRange) {
  const OccupancyGrid open(GridGeometry{0.5, {0.0, 0.0}, 20, 20}, CellState::kFree);
  for (const double range : {0.7, 0.9, 1.1, 2.0, 3.3}) {
    Lidar lidar({.range = range}, 0.0, 1);
    const LaserScan scan = lidar.scan(solid_world(open), {5.0, 5.0, 0.3}, 0.0);
    for (std::size_t b = 0; b < scan.ranges.size(); ++b) ASSERT_FALSE(scan.valid(b)) << range << " m, beam " << b;
  }
}

TEST(Lidar, AFullTurnHasNoDoubledBeam) {
  const OccupancyGrid map(GridGeometry{1.0, {}, 20, 20}, CellState::kFree);
  RobotSpec spec = robot("a", 10.0, 10.0, 30.0);
  spec.beams = 360;
  Simulator sim(map, {spec}, {.lidar = true});
  const LaserScan scan = sim.body(0).sense().scans.at(0).scan;
  EXPECT_NEAR(scan.angle_increment, 2 * kPi / 360, 1e-12);
  EXPECT_NEAR(scan.ranges[180], 10.0, 1e-6) << "ahead: the edge of the map is solid";
}

TEST(Lidar, RaysPassThroughTeamMates) {
  const OccupancyGrid map(GridGeometry{1.0, {}, 20, 5}, CellState::kFree);
  RobotSpec spec = robot("a", 2.0, 2.5, 30.0);
  spec.beams = 1;
  Simulator sim(map, {spec, robot("b", 5.0, 2.5, 5.0)}, {.lidar = true});
  EXPECT_NEAR(sim.body(0).sense().scans.at(0).scan.ranges.at(0), 18.0, 1e-5);
}

TEST(Lidar, ScansComeAtTheirRate) {
  const OccupancyGrid map(GridGeometry{1.0, {}, 40, 5}, CellState::kFree);
  for (const auto& [dt, rate] : {std::pair{0.1, 10.0}, {0.1, 5.0}, {0.05, 4.0}, {1.0, 10.0}, {0.3, 10.0}}) {
    SCOPED_TRACE(testing::Message() << dt << ' ' << rate);
    Simulator sim(map, {robot("a", 2.0, 2.5, 5.0)}, {.dt = dt, .lidar = true, .scan_rate = rate});
    sim.body(0).follow(std::vector<Point>{{38.0, 2.5}});
    const int steps = static_cast<int>(std::round(6.0 / dt));
    for (int i = 0; i < steps; ++i) sim.step();
    const auto& scans = sim.body(0).sense().scans;
    ASSERT_EQ(scans.size(), static_cast<std::size_t>(std::round(6.0 * rate)) + 1);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      EXPECT_NEAR(scans[i].scan.t, static_cast<double>(i) / rate, 1e-6);
      EXPECT_NEAR(scans[i].T_map_robot.x, 2.0 + 4.0 * scans[i].scan.t, 1e-6) << "the pose at the time of the scan";
    }
  }
}

TEST(Lidar, NoiseHasItsSpreadAndAStreamForEachRobot) {
  const OccupancyGrid map(GridGeometry{1.0, {}, 20, 20}, CellState::kFree);
  const auto ranges = [&](std::uint64_t seed, bool both) {
    std::vector<RobotSpec> team{robot("a", 10.0, 10.0, 30.0), robot("b", 5.0, 5.0, 30.0)};
    Simulator sim(map, team, {.lidar = true, .range_noise = 0.02, .seed = seed});
    if (!both) sim.kill(0);
    for (int i = 0; i < 50; ++i) sim.step();
    std::vector<float> all;
    for (const PosedScan& scan : sim.body(1).sense().scans)
      all.insert(all.end(), scan.scan.ranges.begin(), scan.scan.ranges.end());
    return all;
  };
  EXPECT_EQ(ranges(1, true), ranges(1, true));
  EXPECT_EQ(ranges(1, true), ranges(1, false)) << "depends on another robot";
  EXPECT_NE(ranges(1, true), ranges(2, true));

  Simulator exact(map, {robot("a", 10.0, 10.0, 30.0), robot("b", 5.0, 5.0, 30.0)}, {.lidar = true});
  const auto truth = exact.body(1).sense().scans.at(0).scan.ranges;
  double squares = 0.0, sum = 0.0;
  const auto noisy = ranges(1, true);
  for (std::size_t i = 0; i < noisy.size(); ++i) {
    const double error = noisy[i] - truth[i % truth.size()];
    squares += error * error;
    sum += error;
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(noisy.size())), 0.02, 0.001);
  EXPECT_NEAR(sum / static_cast<double>(noisy.size()), 0.0, 0.001);
}

TEST(Simulator, IsReproducible) {
  const World world = embedded_world("office1");
  const auto run = [&](bool lidar) {
    Simulator sim(world.map, world.team, {.lidar = lidar, .range_noise = 0.01, .seed = 9});
    std::mt19937_64 random(4);
    std::vector<double> trace;
    for (int step = 0; step < 300; ++step) {
      for (RobotId id = 0; id < 4; ++id) {
        if (step % 20 == 0) sim.body(id).follow(std::vector<Point>{{uniform(random, 0, 26), uniform(random, 0, 16)}});
        const Sensing& sensing = sim.body(id).sense();
        trace.insert(trace.end(), {sensing.pose.x, sensing.pose.y, sensing.pose.theta, 1.0 * sensing.blocked});
        for (const SeenCell& cell : sensing.cells) trace.push_back(cell.index);
        for (const PosedScan& scan : sensing.scans)
          trace.insert(trace.end(), scan.scan.ranges.begin(), scan.scan.ranges.end());
      }
      sim.step();
    }
    return trace;
  };
  EXPECT_EQ(run(false), run(false));
  EXPECT_EQ(run(true), run(true));
}

}  // namespace
}  // namespace outrider::sim
