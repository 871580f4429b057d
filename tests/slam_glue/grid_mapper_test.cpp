// The mapper beside a slow oracle, and its laws on drawn rooms.

#include "slam_glue/grid_mapper.hpp"

#include <algorithm>
#include <random>
#include <set>

#include "slam_glue/files.hpp"
#include "slam_glue/map_files.hpp"
#include "support/ascii.hpp"
#include "world/ray.hpp"

namespace outrider::slam_glue {
namespace {

using test::grid_from_ascii;
using test::to_ascii;

constexpr std::size_t kBeams = 360;

/// What a noiseless lidar sees all around.
LaserScan look(const OccupancyGrid& world, const Pose2& T_map_robot, double range) {
  LaserScan scan;
  scan.angle_min = -kPi;
  scan.angle_increment = 2.0 * kPi / kBeams;
  scan.range_max = static_cast<float>(range);  // as ranges are (sim::Lidar)
  scan.ranges.resize(kBeams);
  cast_scan(world, T_map_robot.position(), T_map_robot.theta + scan.angle_min, scan.angle_increment, scan.ranges,
            range);
  return scan;
}

OccupancyGrid random_rooms(std::mt19937_64& random) {
  OccupancyGrid world(GridGeometry{0.25, {-3.0, 2.0}, 40, 30}, CellState::kFree);
  for (std::size_t i = 0; i < world.size(); ++i) {
    const Cell c = world.geometry().cell_at(i);
    const bool rim = c.x == 0 || c.y == 0 || c.x == 39 || c.y == 29;
    if (rim || random() % 12 == 0) world[i] = CellState::kOccupied;
  }
  return world;
}

/// Log-odds in whole numbers, each cell of each ray in turn: hits of a scan win over its misses.
class SlowMapper {
 public:
  explicit SlowMapper(const GridGeometry& g) : odds_(g, 0) {}
  void insert(const LaserScan& scan, const Pose2& T_map_robot) {
    const GridGeometry& g = odds_.geometry();
    std::set<std::size_t> missed, hit;
    for (std::size_t b = 0; b < scan.ranges.size(); ++b) {
      const double angle = T_map_robot.theta + scan.angle(b), dx = std::cos(angle), dy = std::sin(angle);
      const double range = scan.valid(b) ? scan.ranges[b] : scan.range_max;
      walk_ray(g, T_map_robot.position(), dx, dy, range,
               [&](Cell c, double) { return missed.insert(g.index(c)), true; });
      const Cell end = g.cell_of({T_map_robot.x + (range + 1e-5) * dx, T_map_robot.y + (range + 1e-5) * dy});
      if (scan.valid(b) && g.contains(end)) hit.insert(g.index(end));
    }
    for (const std::size_t i : hit) missed.erase(i), add(i, -48);
    for (const std::size_t i : missed) add(i, 12);
  }
  CellState state(std::size_t i) const {
    return odds_[i] > 0 ? CellState::kFree : odds_[i] < 0 ? CellState::kOccupied : CellState::kUnknown;
  }

 private:
  void add(std::size_t i, int weight) {
    odds_[i] = std::clamp(odds_[i] + weight, -127, 127);
    if (odds_[i] == 0) odds_[i] = weight > 0 ? 1 : -1;
  }
  Grid<int> odds_;
};

TEST(GridMapper, AgreesWithTheSlowOracle) {
  std::size_t cells = 0, different = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const OccupancyGrid world = random_rooms(random);
    const GridGeometry& g = world.geometry();
    GridMapper mapper(g);
    SlowMapper slow(g);
    OccupancyGrid told(g);  // built from the changes alone
    std::vector<std::uint32_t> changed;
    for (int k = 0; k < 15; ++k) {
      const auto fraction = [&] { return static_cast<double>(random() % 1000) / 1000.0; };
      const Pose2 pose{g.origin.x + (1.0 + 38.0 * fraction()) * g.resolution,
                       g.origin.y + (1.0 + 28.0 * fraction()) * g.resolution, 6.0 * fraction() - 3.0};
      if (world[g.cell_of(pose.position())] != CellState::kFree) continue;
      const LaserScan scan = look(world, pose, 4.0);
      changed.clear();
      mapper.insert(scan, pose, changed);
      slow.insert(scan, pose);
      EXPECT_EQ(std::set<std::uint32_t>(changed.begin(), changed.end()).size(), changed.size());
      for (const std::uint32_t i : changed) {
        EXPECT_NE(told[i], mapper.states()[i]);
        told[i] = mapper.states()[i];
      }
    }
    EXPECT_EQ(told, mapper.states());
    for (std::size_t i = 0; i < world.size(); ++i, ++cells) different += slow.state(i) != mapper.states()[i];
  }
  // Rays that end on a face or pass a corner exactly may be rounded to either side.
  EXPECT_LE(different, cells / 500);
}

TEST(GridMapper, NoiselessScansGiveTheTrueRoom) {
  const OccupancyGrid world = grid_from_ascii(R"(
      #########
      #.......#
      #..###..#
      #.......#
      #.......#
      #########)",
                                              0.5);
  GridMapper mapper(world.geometry());
  std::vector<std::uint32_t> changed;
  // From off the cells' centres, so that no beam runs along a face.
  for (const Pose2& pose : {Pose2{0.81, 0.77, 0.0}, Pose2{3.63, 0.83, 0.3}, Pose2{0.79, 2.21, 1.0},
                            Pose2{3.71, 2.19, -2.0}, Pose2{2.17, 2.23, 0.1}})
    for (int repeat = 0; repeat < 20; ++repeat) mapper.insert(look(world, pose, 10.0), pose, changed);
  for (std::size_t i = 0; i < world.size(); ++i) {
    const CellState state = mapper.states()[i];
    if (world[i] == CellState::kFree) {
      EXPECT_EQ(state, CellState::kFree) << i << '\n' << to_ascii(mapper.states());
    } else {
      EXPECT_NE(state, CellState::kFree) << i << '\n' << to_ascii(mapper.states());
    }
  }
}

/// One beam to the right from (0.5, 0.5) on a row of six cells of 1 m.
LaserScan beam(double range, double range_max) {
  LaserScan scan;
  scan.range_max = range_max;
  scan.ranges = {static_cast<float>(range)};
  return scan;
}

// Beams at 45 degrees from the centre of a cell meet the corners of walls exactly; the echo is of a wall beside them.
TEST(GridMapper, NoFreeCellBehindACornerIsTakenForAWall) {
  std::mt19937_64 random(5);
  for (int round = 0; round < 20; ++round) {
    const OccupancyGrid world = random_rooms(random);
    GridMapper mapper(world.geometry(), {});
    std::vector<std::uint32_t> changed;
    for (std::size_t i = 0; i < world.size(); i += 7) {
      if (world[i] != CellState::kFree) continue;
      const Point at = world.geometry().center(world.geometry().cell_at(i));
      mapper.insert(look(world, {at.x, at.y, 0.0}, 0.9 + 0.1 * round), {at.x, at.y, 0.0}, changed);
    }
    for (std::size_t i = 0; i < world.size(); ++i)
      ASSERT_FALSE(world[i] == CellState::kFree && mapper.states()[i] == CellState::kOccupied) << "round " << round;
  }
}

TEST(GridMapper, OneBeamByHand) {
  struct Case {
    double range, range_max;
    MapperOptions options;
    const char* expected;
  };
  MapperOptions near, shy;
  near.max_range_m = 2.0;
  shy.no_echo_range_m = 1.0;
  for (const Case& c : {Case{2.5, 10, {}, "...#??\n"},   // the wall's very face
                        Case{0.0, 10, {}, "??????\n"},   // a fault of the sensor
                        Case{99, 3.0, {}, "....??\n"},   // no echo clears
                        Case{99, 3.0, shy, "..????\n"},  // but no farther than told
                        Case{std::numeric_limits<double>::quiet_NaN(), 3.0, {}, "....??\n"},
                        Case{4.0, 10, near, "...???\n"},    // beyond max_range: clears
                        Case{50.0, 80, {}, "......\n"}}) {  // echo outside the map
    SCOPED_TRACE(c.expected);
    GridMapper mapper(GridGeometry{1.0, {0.0, 0.0}, 6, 1}, c.options);
    std::vector<std::uint32_t> changed;
    mapper.insert(beam(c.range, c.range_max), {0.5, 0.5, 0.0}, changed);
    EXPECT_EQ(to_ascii(mapper.states()), c.expected);
  }
}

TEST(GridMapper, AHitWinsWithinAScanAndOutweighsGrazingRays) {
  GridMapper mapper(GridGeometry{1.0, {0.0, 0.0}, 6, 1});
  std::vector<std::uint32_t> changed;
  LaserScan both = beam(2.5, 10);
  both.ranges = {4.5F, 2.5F, 4.5F};  // three beams the same way: cell 3 is hit once and passed twice
  mapper.insert(both, {0.5, 0.5, 0.0}, changed);
  EXPECT_EQ(to_ascii(mapper.states()), "...#.#\n");
  for (int i = 0; i < 3; ++i) mapper.insert(beam(4.5, 10), {0.5, 0.5, 0.0}, changed);
  EXPECT_EQ(to_ascii(mapper.states()), "...#.#\n");
  for (int i = 0; i < 3; ++i) mapper.insert(beam(4.5, 10), {0.5, 0.5, 0.0}, changed);  // but not for ever
  EXPECT_EQ(to_ascii(mapper.states()), ".....#\n");
}

TEST(GridMapper, SavedMapComesBack) {
  const test::TempDir dir;
  GridMapper mapper(GridGeometry{1.0, {-2.0, 3.0}, 6, 1});
  std::vector<std::uint32_t> changed;
  mapper.insert(beam(2.5, 10), {-1.5, 3.5, 0.0}, changed);
  mapper.save(dir / "map.gridmap");
  EXPECT_EQ(load_map(dir / "map.gridmap").grid, mapper.states());
}

}  // namespace
}  // namespace outrider::slam_glue
