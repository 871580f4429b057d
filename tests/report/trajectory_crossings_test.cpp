#include "report/trajectory_crossings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "records.hpp"

namespace outrider::report {
namespace {

std::size_t crossings(const Corners& a, const Corners& b) {
  return trajectory_crossings(std::vector{drive(a), drive(b)}).count;
}

struct Case {
  const char* what;
  Corners a, b;
  std::size_t expected;
};

TEST(TrajectoryCrossings, KnownAnswers) {
  const Corners line{{0, 0}, {10, 0}};
  const std::vector<Case> cases{
      {"plain crossing", line, {{5, -1}, {5, 1}}, 1},
      {"apart", line, {{5, 1}, {5, 3}}, 0},
      {"through a vertex of the other", {{0, 0}, {5, 0}, {10, 1}}, {{5, -1}, {5, 1}}, 1},
      {"vertex on vertex, crossing", {{0, 0}, {5, 0}, {10, 1}}, {{4, -3}, {5, 0}, {4, 3}}, 1},
      {"vertex on vertex, touch", {{0, 0}, {5, 0}, {10, 1}}, {{4, 3}, {5, 0}, {6, 3}}, 0},
      {"own vertex on the line, crossing", line, {{4, 3}, {5, 0}, {6, -3}}, 1},
      {"own vertex on the line, touch from above", line, {{4, 3}, {5, 0}, {6, 3}}, 0},
      {"own vertex on the line, touch from below", line, {{4, -3}, {5, 0}, {6, -3}}, 0},
      {"shared stretch, other side", line, {{2, -1}, {3, 0}, {6, 0}, {7, 1}}, 1},
      {"shared stretch, same side", line, {{2, 1}, {3, 0}, {6, 0}, {7, 1}}, 0},
      {"shared stretch against the direction, other side", line, {{7, -1}, {6, 0}, {3, 0}, {2, 1}}, 1},
      {"shared stretch against the direction, same side", line, {{7, 1}, {6, 0}, {3, 0}, {2, 1}}, 0},
      {"begins on the other", line, {{5, 0}, {5, 3}}, 0},
      {"ends on the other", line, {{5, 3}, {5, 0}}, 0},
      {"shared to the end", line, {{5, 3}, {6, 0}, {10, 0}}, 0},
      {"identical", line, line, 0},
      {"there and back across", line, {{5, -1}, {5, 1}, {6, 1}, {6, -1}}, 2},
      {"turns back on the other side, the same way", line, {{5, -1}, {5, 1}, {5, -1}}, 2},
      {"standing robot", line, {{5, 0}}, 0},
      {"shared corner", {{0, 0}, {5, 0}, {5, 5}}, {{-1, -1}, {2, 0}, {5, 0}, {5, 3}, {4, 4}}, 1},
      {"crossing while the other waits there", {{0, 0}, {5, 0}, {5, 0}, {5, 0}, {10, 0}}, {{5, -1}, {5, 1}}, 1},
  };
  for (const Case& c : cases) {
    SCOPED_TRACE(c.what);
    EXPECT_EQ(crossings(c.a, c.b), c.expected);
    EXPECT_EQ(crossings(c.b, c.a), c.expected) << "roles exchanged";
    EXPECT_EQ(crossings(Corners(c.a.rbegin(), c.a.rend()), c.b), c.expected) << "driven backwards";
  }
}

TEST(TrajectoryCrossings, PerRobotCountsAsInTable1OfDai2014) {
  // b crosses a and c; a and c are parallel. Their sum is twice the count, as in the table (48 = 11 + 4 + 22 + 11).
  const Crossings c = trajectory_crossings(
      std::vector{drive({{0, 0}, {10, 0}}), drive({{5, -1}, {5, 3}}), drive({{0, 2}, {10, 2}}), drive({})});
  EXPECT_EQ(c.count, 2U);
  EXPECT_EQ(c.per_robot, (std::vector<std::size_t>{1, 2, 1, 0}));
}

TEST(TrajectoryCrossings, OwnLoopsDoNotCount) {
  EXPECT_EQ(trajectory_crossings(std::vector<std::vector<TimedPose>>{drive({{0, 0}, {4, 4}, {4, 0}, {0, 4}})}).count,
            0U);
}

TEST(TrajectoryCrossings, SamplingAlongTheSameSlantedLineDoesNotMatter) {
  // Two robots drive one slanted corridor, sampled at different rates: rounded samples must not weave.
  std::vector<TimedPose> a, b;
  for (int i = 0; i <= 1000; ++i) a.push_back({0.1 * i, {0.0123 * i, 0.00713 * i, 0.0}});
  for (int i = 0; i <= 777; ++i) b.push_back({0.1 * i, {0.0123 * i / 0.777, 0.00713 * i / 0.777, 0.0}});
  EXPECT_EQ(trajectory_crossings(std::vector{a, b}).count, 0U);
}

double cross(Point o, Point a, Point b) { return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x); }

std::size_t all_pairs(const std::vector<TimedPose>& a, const std::vector<TimedPose>& b) {
  std::size_t n = 0;
  for (std::size_t i = 1; i < a.size(); ++i)
    for (std::size_t j = 1; j < b.size(); ++j) {
      const Point a0 = a[i - 1].pose.position(), a1 = a[i].pose.position();
      const Point b0 = b[j - 1].pose.position(), b1 = b[j].pose.position();
      n += cross(a0, a1, b0) * cross(a0, a1, b1) < 0 && cross(b0, b1, a0) * cross(b0, b1, a1) < 0;
    }
  return n;
}

TEST(TrajectoryCrossings, AgreesWithAllPairsInGeneralPosition) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> step(-4.0, 4.0);
    std::vector<std::vector<TimedPose>> team(3);
    for (auto& path : team) {
      Pose2 p;
      for (int i = 0; i < 200; ++i, p.x += step(random), p.y += step(random)) path.push_back({0.1 * i, p});
      path.front().pose.x += step(random);  // all begin at different places
      path.front().pose.y += step(random);
    }
    const Crossings c = trajectory_crossings(team);
    const std::size_t ab = all_pairs(team[0], team[1]), ac = all_pairs(team[0], team[2]),
                      bc = all_pairs(team[1], team[2]);
    EXPECT_EQ(c.count, ab + ac + bc);
    EXPECT_EQ(c.per_robot, (std::vector<std::size_t>{ab + ac, ab + bc, ac + bc}));
  }
}

/// A walk on a small lattice (so that contacts abound) that never turns back on the spot.
Corners lattice_walk(std::mt19937_64& random, int steps) {
  constexpr std::array<std::pair<int, int>, 8> kMoves{
      {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
  int x = static_cast<int>(random() % 7), y = static_cast<int>(random() % 7);
  std::size_t heading = random() % 8;
  Corners walk{{x, y}};
  while (static_cast<int>(walk.size()) < steps) {
    const std::size_t turned = (heading + 5 + random() % 7) % 8;  // anything but back
    const auto [dx, dy] = kMoves[turned];
    if (x + dx < 0 || x + dx > 6 || y + dy < 0 || y + dy > 6) continue;
    heading = turned;
    walk.emplace_back(x += dx, y += dy);
  }
  return walk;
}

TEST(TrajectoryCrossings, LawsOnCrowdedLattices) {
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937_64 random(seed);
    const Corners a = lattice_walk(random, 12), b = lattice_walk(random, 12);
    const std::size_t n = crossings(a, b);
    EXPECT_EQ(crossings(b, a), n) << "symmetric";
    EXPECT_EQ(crossings(Corners(a.rbegin(), a.rend()), b), n) << "reversed";
    Corners turned_a, turned_b, fine;
    for (const auto& [x, y] : a) turned_a.emplace_back(-3 * y + 100, 3 * x - 50);
    for (const auto& [x, y] : b) turned_b.emplace_back(-3 * y + 100, 3 * x - 50);
    EXPECT_EQ(crossings(turned_a, turned_b), n) << "turned, scaled and moved";
    for (std::size_t i = 0; i < a.size(); ++i) {
      fine.push_back(a[i]);
      if (i + 1 < a.size())
        fine.emplace_back(0.5 * (a[i].first + a[i + 1].first), 0.5 * (a[i].second + a[i + 1].second));
    }
    EXPECT_EQ(crossings(fine, b), n) << "subdivided";
  }
}

}  // namespace
}  // namespace outrider::report
