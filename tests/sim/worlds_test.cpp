#include <gtest/gtest.h>

#include <numeric>
#include <queue>
#include <set>

#include "sim/simulator.hpp"
#include "sim/walls.hpp"
#include "sim/world.hpp"
#include "support/ascii.hpp"
#include "world/error.hpp"

namespace outrider::sim {
namespace {

template <class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Sizes of the regions that a disc can drive in (4 neighbours), and the region of each cell (-1: none).
std::pair<std::vector<int>, Grid<int>> regions(const OccupancyGrid& map, double radius) {
  const Walls walls(map, radius);
  std::pair<std::vector<int>, Grid<int>> result{{}, Grid<int>(map.geometry(), -1)};
  auto& [sizes, region] = result;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (region[i] >= 0 || !walls.passable(map.geometry().cell_at(i))) continue;
    std::queue<Cell> open;
    open.push(map.geometry().cell_at(i));
    region[i] = static_cast<int>(sizes.size());
    sizes.push_back(0);
    for (; !open.empty(); open.pop()) {
      ++sizes.back();
      for (const Cell step : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
        const Cell next{open.front().x + step.x, open.front().y + step.y};
        if (!walls.passable(next) || region[next] >= 0) continue;
        region[next] = region[i];
        open.push(next);
      }
    }
  }
  return result;
}

struct Expected {
  const char* name;
  double width, height, resolution;
  std::size_t robots;
};

class EmbeddedWorlds : public testing::TestWithParam<Expected> {};

TEST_P(EmbeddedWorlds, AreWhatTheyClaim) {
  const Expected expected = GetParam();
  const World world = embedded_world(expected.name);
  const GridGeometry& g = world.map.geometry();
  EXPECT_EQ(world.name, expected.name);
  EXPECT_FALSE(world.provenance.empty());
  EXPECT_DOUBLE_EQ(g.resolution, expected.resolution);
  EXPECT_NEAR(g.width * g.resolution, expected.width, 1e-9);
  EXPECT_NEAR(g.height * g.resolution, expected.height, 1e-9);
  EXPECT_EQ(world.team.size(), expected.robots);
  EXPECT_GE(world.starts.size(), 16U);
  EXPECT_NO_THROW(Simulator(world.map, world.team, {}));
}

TEST_P(EmbeddedWorlds, AreConnectedForTheirRobots) {
  const World world = embedded_world(GetParam().name);
  for (const double radius : {0.2, world.team[0].radius}) {
    const auto [sizes, region] = regions(world.map, radius);
    const int largest = *std::max_element(sizes.begin(), sizes.end());
    const double share = static_cast<double>(largest) / std::accumulate(sizes.begin(), sizes.end(), 0);
    RecordProperty("largest_region", std::to_string(share));
    EXPECT_GE(share, 0.99) << radius;
    for (const Pose2& start : world.starts) {
      const int at = region[world.map.geometry().cell_of(start.position())];
      ASSERT_GE(at, 0) << start.x << ' ' << start.y;
      EXPECT_EQ(sizes[static_cast<std::size_t>(at)], largest) << start.x << ' ' << start.y;
    }
  }
}

TEST_P(EmbeddedWorlds, HaveRoomForTeamsOfSixteen) {
  const World world = embedded_world(GetParam().name);
  const std::vector<double> radii(16, world.team[0].radius);
  const auto starts = spread_starts(world, radii);
  ASSERT_EQ(starts.size(), 16U);
  for (std::size_t i = 0; i < starts.size(); ++i) EXPECT_EQ(starts[i], world.starts[i]) << "robots in each other's way";
}

INSTANTIATE_TEST_SUITE_P(All, EmbeddedWorlds,
                         testing::Values(Expected{"field", 100, 100, 1.0, 4}, Expected{"labyrinth", 32, 26, 0.2, 3},
                                         Expected{"office", 50, 30, 0.1, 4}, Expected{"office1", 26, 16, 0.25, 4},
                                         Expected{"office2", 30, 20, 0.25, 3}, Expected{"urban", 32, 26, 0.2, 3}),
                         [](const auto& world) { return std::string(world.param.name); });

TEST(EmbeddedWorlds, AreListedWithOneLineEach) {
  EXPECT_EQ(embedded_worlds(),
            (std::vector<std::string>{"field", "labyrinth", "office", "office1", "office2", "urban"}));
  const auto infos = embedded_world_infos();
  ASSERT_EQ(infos.size(), 6U);
  EXPECT_EQ(infos[0].one_line.substr(0, 67), "field      100 x 100 m, 100 x 100 cells of 1 m, 16 starts, 4 robots");
  for (const WorldInfo& info : infos) EXPECT_EQ(info.one_line.find('\n'), std::string::npos);
}

TEST(EmbeddedWorlds, UnknownNamesGetASuggestion) {
  EXPECT_EQ(error_of([] { (void)embedded_world("feild"); }), "unknown world 'feild'; did you mean 'field'?");
}

TEST(Field, KeepsThePublishedStartCellsFree) {
  const World world = embedded_world("field");
  for (const Cell c : {Cell{97, 36}, Cell{5, 76}, Cell{89, 29}, Cell{25, 93}, Cell{14, 1}, Cell{5, 1}, Cell{60, 3},
                       Cell{87, 2}, Cell{44, 7}, Cell{29, 99}, Cell{78, 99}, Cell{1, 66}, Cell{95, 23}, Cell{60, 5}})
    EXPECT_EQ(world.map[c], CellState::kFree) << c.x << ' ' << c.y;
  EXPECT_EQ(world.map.geometry().cell_of(world.starts[0].position()), (Cell{97, 36}));
  EXPECT_EQ(world.team[1].speed, 4.0);
  EXPECT_EQ(world.team[1].range, 8.0);
  const auto occupied = std::count(world.map.data().begin(), world.map.data().end(), CellState::kOccupied);
  EXPECT_GT(occupied, 900);
  EXPECT_LT(occupied, 1100);
}

TEST(ParseWorld, ReadsAPlainDrawing) {
  const World world = parse_world("#####\n#1.0#\n#####\n", "drawing", 0.5);
  EXPECT_EQ(test::to_ascii(world.map), "#####\n#...#\n#####\n");
  EXPECT_EQ(world.map.geometry().resolution, 0.5);
  ASSERT_EQ(world.starts.size(), 2U);
  EXPECT_EQ(world.starts[0], (Pose2{1.75, 0.75, 0.0}));
  EXPECT_EQ(world.starts[1], (Pose2{0.75, 0.75, 0.0}));
  EXPECT_EQ(parse_world("..\r\n#.\r\n\r\n", "dos").map.size(), 4U);
}

TEST(ParseWorld, ReadsTheHeader) {
  const World world = parse_world(R"(provenance: drawn here
resolution: 2
origin: -1 3.5
start: 2 4.5 1.57
robot: name=a speed=0.7 range=3 radius=0.3 fov=3.14 beams=181
map:
.0.
...
)",
                                  "text");
  EXPECT_EQ(world.provenance, "drawn here");
  EXPECT_EQ(world.map.geometry(), (GridGeometry{2.0, {-1.0, 3.5}, 3, 2}));
  ASSERT_EQ(world.starts.size(), 2U);
  EXPECT_EQ(world.starts[1], (Pose2{2.0, 4.5, 1.57}));
  ASSERT_EQ(world.team.size(), 1U);
  EXPECT_EQ(world.team[0], (RobotSpec{"a", world.starts[0], 0.7, 3.0, 3.14, 181, 0.3}));
}

TEST(ParseWorld, ErrorsNameTheLine) {
  const auto error = [](std::string_view text) { return error_of([&] { (void)parse_world(text, "f.txt"); }); };
  EXPECT_EQ(error("..\n...\n"), "f.txt, line 2: the row has 3 cells, the first one 2");
  EXPECT_EQ(error("..\n.x\n"), "f.txt, line 2: column 2: expected '#', '.' or a digit, not 'x'");
  EXPECT_EQ(error("1.\n.1\n"), "f.txt, line 2: column 2: start 1 is there twice");
  EXPECT_EQ(error(""), "f.txt, line 1: expected the rows of a map");
  EXPECT_EQ(error("map:\n"), "f.txt, line 2: expected the rows of a map");
  EXPECT_EQ(error("resolutoin: 1\nmap:\n.\n"), "f.txt, line 1: unknown key 'resolutoin'; did you mean 'resolution'?");
  EXPECT_EQ(error("resolution: 1m\nmap:\n.\n"), "f.txt, line 1: expected a number, not '1m'");
  EXPECT_EQ(error("resolution: 0\nmap:\n.\n"), "f.txt, line 3: resolution 0: expected a positive number of m");
  EXPECT_EQ(error("start: 1 2\nmap:\n.\n"), "f.txt, line 1: expected 3 numbers, found 2");
  EXPECT_EQ(error("robot: name=a\nmap:\n.\n"), "f.txt, line 1: there are more robots than starts");
  EXPECT_EQ(error("robot: name=a beams=1.5\nmap:\n0\n"), "f.txt, line 1: expected a whole number, not '1.5'");
  EXPECT_EQ(error("robot: name=a colour=1\nmap:\n0\n").substr(0, 36), "f.txt, line 1: unknown key 'colour';");
}

TEST(SpreadStarts, FillsUpNextToTheGivenOnes) {
  const World world = parse_world("........\n.0......\n........\n........\n", "w");
  const std::vector<double> radii(5, 0.45);
  const auto starts = spread_starts(world, radii);
  ASSERT_EQ(starts.size(), 5U);
  EXPECT_EQ(starts[0], world.starts[0]);
  for (std::size_t i = 0; i < starts.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_GE(distance(starts[i].position(), starts[j].position()), 0.99);
  for (std::size_t i = 1; i < 5; ++i)
    EXPECT_EQ(distance(starts[i].position(), starts[0].position()), 1.0) << "not the nearest";
  EXPECT_EQ(starts, spread_starts(world, radii));
}

TEST(SpreadStarts, StaysOnThisSideOfTheWall) {
  const World world = parse_world(".0#....\n..#....\n..#....\n", "w");
  for (const Pose2& start : spread_starts(world, std::vector<double>(4, 0.3))) EXPECT_LT(start.x, 2.0);
  EXPECT_EQ(error_of([&] { (void)spread_starts(world, std::vector<double>(7, 0.4)); }),
            "no room for robot 7 of 7 (radius 0.4 m) near the start poses");
}

TEST(SpreadStarts, MovesSharedStartsAndRefusesWalls) {
  World world = parse_world("........\n...#....\n........\n", "w");
  world.starts = {{1.5, 1.5, 0.5}, {1.5, 1.5, 0.5}, {1.5, 1.5, 0.5}};
  const auto starts = spread_starts(world, std::vector<double>(3, 0.4));
  EXPECT_EQ(starts[0], world.starts[0]);
  EXPECT_EQ(distance(starts[1].position(), starts[0].position()), 1.0);
  EXPECT_EQ(starts[1].theta, 0.5);
  world.starts[1] = {3.5, 1.5, 0.0};
  EXPECT_EQ(error_of([&] { (void)spread_starts(world, std::vector<double>(3, 0.4)); }),
            "robot 2 at (3.5, 1.5): its start is in a wall or off the map (radius 0.4 m)");
}

TEST(SpreadStarts, WithoutAnyBeginsInTheLargestRegion) {
  const World world = parse_world("..#.....\n..#.....\n..#.....\n", "w");
  const auto starts = spread_starts(world, std::vector<double>(2, 0.3));
  for (const Pose2& start : starts) EXPECT_GT(start.x, 3.0);
  EXPECT_NO_THROW(Simulator(world.map, {{"a", starts[0], 1, 1, 1, 1, 0.3}, {"b", starts[1], 1, 1, 1, 1, 0.3}}, {}));
  EXPECT_TRUE(spread_starts(world, {}).empty());
}

TEST(RandomStarts, ReachTheWholeSideOfTheWallAndNoMore) {
  const World world = parse_world(".0..#...\n....#...\n....#...\n", "w");
  const std::vector<double> radii(2, 0.3);
  std::set<std::pair<double, double>> places;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const auto starts = random_starts(world, radii, seed);
    ASSERT_EQ(starts.size(), 2U);
    EXPECT_GE(distance(starts[0].position(), starts[1].position()), 0.6) << "seed " << seed;
    for (const Pose2& start : starts) {
      EXPECT_LT(start.x, 4.0) << "seed " << seed;
      places.insert({start.x, start.y});
    }
    EXPECT_EQ(starts, random_starts(world, radii, seed));
  }
  EXPECT_EQ(places.size(), 12U);
  EXPECT_THROW((void)random_starts(world, std::vector<double>(13, 0.4), 1), InputError);
}

}  // namespace
}  // namespace outrider::sim
