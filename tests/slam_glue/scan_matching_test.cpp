// Scan matching: point-to-line against known transforms, branch and bound against trying everything.

#include <gtest/gtest.h>

#include "slam_glue/correlative.hpp"
#include "slam_glue/point_matcher.hpp"
#include "slam_glue/segment_world.hpp"

namespace outrider::slam_glue {
namespace {

using test::SegmentWorld;

std::vector<SurfacePoint> seen_from(const SegmentWorld& world, const Pose2& pose, std::mt19937& random) {
  return surface_points(world.scan(pose, 0.0, 361, kPi, random, 0.005), 20.0, 0.03);
}

TEST(PointMatcher, FindsTheMotionBetweenTwoScans) {
  const SegmentWorld world = test::ring_world();
  for (unsigned seed = 1; seed <= 20; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-0.15, 0.15), turn(-0.1, 0.1);
    const Pose2 first{2.0, 1.0, 0.3}, second = first * Pose2{shift(random), shift(random), turn(random)};
    const PointMap map(seen_from(world, first, random));
    const PointMatch match = match_points(map, seen_from(world, second, random), {}, 0.02);
    const Pose2 error = inverse(inverse(first) * second) * match.T_map_robot;
    EXPECT_LT(std::hypot(error.x, error.y), 0.02) << "seed " << seed;
    EXPECT_LT(std::abs(error.theta), 0.01) << "seed " << seed;
    EXPECT_TRUE(match.bound) << "seed " << seed;
    EXPECT_GT(match.share, 0.6) << "seed " << seed;
  }
}

TEST(PointMatcher, ABareCorridorBindsOnlyAcross) {
  const SegmentWorld world({{{-100, 0}, {100, 0}}, {{-100, 2}, {100, 2}}});
  std::mt19937 random(1);
  const PointMap map(seen_from(world, {0.0, 1.0, 0.0}, random));
  PosePrior prior{{0.5, 0.0, 0.0}, Eigen::Vector3d(1e4, 1.0, 1.0).asDiagonal()};
  const PointMatch match = match_points(map, seen_from(world, {0.3, 1.1, 0.02}, random), {}, 0.02, prior);
  EXPECT_FALSE(match.bound);
  EXPECT_NEAR(match.T_map_robot.x, 0.5, 0.05) << "nothing but the prior speaks along the corridor";
  EXPECT_NEAR(match.T_map_robot.y, 0.1, 0.01);
  EXPECT_NEAR(match.T_map_robot.theta, 0.02, 0.005);
  EXPECT_LT(match.information(0, 0), 1e-6 * match.information(1, 1));
}

/// Every pose of the lattice that CorrelativeMatcher documents, by looking at a matcher of one level.
TEST(CorrelativeMatcher, AgreesWithTryingEverything) {
  const SegmentWorld world = test::ring_world();
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> shift(-0.8, 0.8), turn(-0.3, 0.3);
    const Pose2 truth{shift(random), shift(random), turn(random)};
    const Pose2 base{1.0 + 0.5 * seed, 1.0, 0.0};
    const auto map = thinned(seen_from(world, base, random), 0.05);
    const auto scan = thinned(seen_from(world, base * truth, random), 0.2);
    for (const double sigma : {0.0, 0.3}) {
      const SearchWindow window{{}, 1.0, 0.4, sigma, sigma};
      const auto fast = CorrelativeMatcher(map, 0.05, 5).best(scan, window, 0.1);
      const auto slow = CorrelativeMatcher(map, 0.05, 1).best(scan, window, 0.1);  // one level: no bounds to err with
      ASSERT_TRUE(fast && slow) << "seed " << seed;
      EXPECT_DOUBLE_EQ(fast->score, slow->score) << "seed " << seed << ", sigma " << sigma;
    }
    const auto hit = CorrelativeMatcher(map, 0.05, 5).best(scan, {{}, 1.0, 0.4}, 0.1);
    EXPECT_LT(distance(hit->T_map_robot.position(), truth.position()), 0.15) << "seed " << seed;
    const auto rival = CorrelativeMatcher(map, 0.05, 5).best(scan, {{}, 1.0, 0.4}, 0.05, hit->T_map_robot);
    EXPECT_LE(rival ? rival->score : 0.0, hit->score);
    EXPECT_FALSE(CorrelativeMatcher(map, 0.05, 5).best(scan, {{}, 1.0, 0.4}, 1.01)) << "nothing scores above 1";
  }
}

TEST(SurfacePoints, NormalsFaceTheSensor) {
  std::mt19937 random(3);
  for (const auto& q : seen_from(test::ring_world(), {1.0, 1.0, 0.5}, random)) {
    if (!q.has_normal()) continue;
    EXPECT_NEAR(std::hypot(q.normal.x, q.normal.y), 1.0, 1e-9);
    EXPECT_LT(q.normal.x * q.p.x + q.normal.y * q.p.y, 0.0);
  }
}

}  // namespace
}  // namespace outrider::slam_glue
