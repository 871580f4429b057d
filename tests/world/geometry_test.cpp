#include "world/geometry.hpp"

#include <gtest/gtest.h>

#include <random>

namespace outrider {
namespace {

Pose2 random_pose(std::mt19937_64& random) {
  std::uniform_real_distribution<double> metres(-20.0, 20.0), radians(-kPi, kPi);
  return {metres(random), metres(random), radians(random)};
}

void expect_near(const Pose2& a, const Pose2& b) {
  EXPECT_NEAR(a.x, b.x, 1e-9);
  EXPECT_NEAR(a.y, b.y, 1e-9);
  EXPECT_NEAR(wrap_angle(a.theta - b.theta), 0.0, 1e-9);
}

TEST(WrapAngle, LiesInTheHalfOpenTurn) {
  EXPECT_DOUBLE_EQ(wrap_angle(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(-kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(0.0), 0.0);
  for (double a = -50.0; a < 50.0; a += 0.37) {
    EXPECT_GT(wrap_angle(a), -kPi);
    EXPECT_LE(wrap_angle(a), kPi);
    EXPECT_NEAR(std::sin(wrap_angle(a)), std::sin(a), 1e-12);
    EXPECT_NEAR(std::cos(wrap_angle(a)), std::cos(a), 1e-12);
  }
}

TEST(Pose2, FormsAGroup) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    const Pose2 a = random_pose(random), b = random_pose(random), c = random_pose(random);
    expect_near((a * b) * c, a * (b * c));
    expect_near(a * inverse(a), {});
    expect_near(inverse(a * b), inverse(b) * inverse(a));
    expect_near(a * Pose2{}, a);
    const Point p{c.x, c.y}, q = (a * b) * p, r = a * (b * p);
    EXPECT_NEAR(distance(q, r), 0.0, 1e-9);
  }
}

TEST(Pose2, TurnsLeft) {
  const Pose2 T_map_robot{1.0, 2.0, kPi / 2.0};
  const Point ahead = T_map_robot * Point{1.0, 0.0};
  EXPECT_NEAR(ahead.x, 1.0, 1e-12);
  EXPECT_NEAR(ahead.y, 3.0, 1e-12);
}

}  // namespace
}  // namespace outrider
