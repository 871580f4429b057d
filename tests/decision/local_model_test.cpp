// The Local Interpreter and the controllers on places drawn in ASCII, seen by ray casting.

#include "decision/local_model.hpp"

#include <gtest/gtest.h>

#include "decision/controllers.hpp"
#include "support/ascii.hpp"
#include "world/ray.hpp"

namespace outrider::decision {
namespace {

/// What a scanner at `T_map_robot` sees; '#' is a wall.
LaserScan look(const OccupancyGrid& map, const Pose2& T_map_robot, double range = 20.0) {
  LaserScan scan{.angle_min = -kPi, .angle_increment = 2.0 * kPi / 720, .range_max = range};
  scan.ranges.resize(720);
  cast_scan(map, T_map_robot.position(), T_map_robot.theta - kPi, scan.angle_increment, scan.ranges, range);
  return scan;
}

/// 0.2 m a character; R is where the robot stands.
std::pair<OccupancyGrid, Point> place(const std::vector<std::string>& rows) {
  const int h = static_cast<int>(rows.size()), w = static_cast<int>(rows[0].size());
  OccupancyGrid map({0.2, {0.0, 0.0}, w, h}, CellState::kFree);
  Point robot;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const char c = rows[static_cast<std::size_t>(h - 1 - y)][static_cast<std::size_t>(x)];
      if (c == '#') map[Cell{x, y}] = CellState::kOccupied;
      if (c == 'R') robot = map.geometry().center({x, y});
    }
  return {map, robot};
}

LocalView at(const std::vector<std::string>& rows, double theta = 0.0) {
  const auto [map, robot] = place(rows);
  return LocalInterpreter{.range = 2.0, .passage = 0.6}(look(map, {robot.x, robot.y, theta}));
}

const std::vector<std::string> kCrossing{"#########.....#########", "#########.....#########", "#########.....#########", "#########.....#########",
                                         "#########.....#########", "#########.....#########", "#########.....#########", "#########.....#########",
                                         "#########.....#########", ".......................", ".......................", "...........R...........",
                                         ".......................", ".......................", "#########.....#########", "#########.....#########",
                                         "#########.....#########", "#########.....#########", "#########.....#########", "#########.....#########",
                                         "#########.....#########", "#########.....#########", "#########.....#########"};

std::vector<std::string> closed(std::vector<std::string> rows, std::size_t from, std::size_t to, std::size_t left, std::size_t right) {
  for (std::size_t y = from; y < to; ++y)
    for (std::size_t x = left; x < right; ++x) rows[y][x] = '#';
  return rows;
}

TEST(LocalInterpreter, TellsTheEightStatesApart) {
  EXPECT_EQ(at(std::vector<std::string>(23, "...........R...........")).state, SemanticState::kFreeSpace);  // R in a row of its own
  EXPECT_EQ(at(kCrossing).state, SemanticState::kIntersection);
  const auto junction = closed(kCrossing, 0, 9, 9, 14);
  EXPECT_EQ(at(junction).state, SemanticState::kJunction);
  const auto corridor = closed(junction, 14, 23, 9, 14);
  EXPECT_EQ(at(corridor).state, SemanticState::kCorridor);
  EXPECT_EQ(at(closed(corridor, 9, 14, 14, 23)).state, SemanticState::kDeadEnd);
}

TEST(LocalInterpreter, OpenExitsMakeTheOtherStates) {
  std::vector<std::string> open(23, ".......................");
  open[11][11] = 'R';
  EXPECT_EQ(at(closed(open, 0, 23, 0, 6)).state, SemanticState::kOneObstacle);  // a wall on the left side only
  EXPECT_EQ(at(closed(closed(open, 10, 13, 4, 6), 10, 13, 17, 19)).state, SemanticState::kGate);
  EXPECT_EQ(at(closed(closed(open, 0, 9, 0, 11), 14, 23, 0, 11)).state, SemanticState::kFunnel);  // a corridor ends here
}

TEST(LocalInterpreter, ExitsAreCountedFromTheLeftWhateverTheHeading) {
  const LocalView east = at(closed(kCrossing, 9, 14, 0, 9), 0.0);  // ways north, east, south
  ASSERT_EQ(east.exits.size(), 3U);
  EXPECT_NEAR(east.exits[0].bearing, kPi / 2, 0.1);
  EXPECT_NEAR(east.exits[1].bearing, 0.0, 0.1);
  EXPECT_NEAR(east.exits[2].bearing, -kPi / 2, 0.1);
  const LocalView turned = at(closed(kCrossing, 9, 14, 0, 9), kPi / 4);
  ASSERT_EQ(turned.exits.size(), 3U);
  EXPECT_NEAR(turned.exits[0].bearing, kPi / 4, 0.1);
  EXPECT_NEAR(turned.exits[2].bearing, -3 * kPi / 4, 0.1);
  EXPECT_FALSE(turned.exits[0].open);
  EXPECT_NEAR(turned.exits[0].width, 1.0, 0.15);
}

/// Drives with a controller through a true map; never nearer to a wall than the radius.
bool drive(const std::vector<std::string>& rows, Point target, double radius) {
  const auto [map, start] = place(rows);
  Pose2 pose{start.x, start.y, 0.0};
  const LocalInterpreter interpret{.range = 3.0, .passage = 2.0 * radius + 0.1};
  const ReachingController reach{.radius = radius};
  std::optional<double> last;
  for (int k = 0; k < 600; ++k) {
    if (distance(pose.position(), target) < 0.1) return true;
    const LocalView model = interpret(look(map, pose));
    const auto h = reach.heading(model, inverse(pose) * target, last);
    if (!h) return false;
    pose = pose * Pose2{0.05 * std::cos(*h), 0.05 * std::sin(*h), *h};
    last = 0.0;
    for (std::size_t i = 0; i < map.size(); ++i)
      if (map[i] == CellState::kOccupied) {
        const Point c = map.geometry().center(map.geometry().cell_at(i));
        const double d = std::hypot(std::max(0.0, std::abs(pose.x - c.x) - 0.1), std::max(0.0, std::abs(pose.y - c.y) - 0.1));
        EXPECT_GE(d, radius - 0.03);
      }
  }
  return false;
}

TEST(ReachingController, GoesRoundConvexObstacles) {
  std::vector<std::string> rows(25, std::string(40, '.'));
  rows[12][3] = 'R';
  const auto [open, start] = place(rows);
  const Point target{start.x + 6.0, start.y};
  EXPECT_TRUE(drive(rows, target, 0.2));
  EXPECT_TRUE(drive(closed(rows, 9, 15, 15, 20), target, 0.2));
  EXPECT_TRUE(drive(closed(closed(rows, 8, 14, 12, 15), 11, 18, 22, 26), target, 0.2));
}

TEST(ReachingController, SaysWhenItIsWalledIn) {
  const auto model = at({"#####", "#...#", "#.R.#", "#...#", "#####"});
  EXPECT_FALSE((ReachingController{.radius = 0.45}.heading(model, {2.0, 0.0})).has_value());
}

TEST(TopologicalController, TakesTheExitThatWasCounted) {
  const LocalView model = at(kCrossing);
  ASSERT_EQ(model.exits.size(), 4U);
  const auto left = exit_towards(model, kPi / 2);
  ASSERT_TRUE(left);
  const auto h = TopologicalController{{.radius = 0.2}}.heading(model, *left);
  ASSERT_TRUE(h);
  EXPECT_NEAR(*h, kPi / 2, 0.2);
}

}  // namespace
}  // namespace outrider::decision
