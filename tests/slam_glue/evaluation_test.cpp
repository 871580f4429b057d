// Errors of trajectories against numbers worked out by hand.

#include "slam_glue/evaluation.hpp"

#include <cmath>

#include "slam_glue/files.hpp"

namespace outrider::slam_glue {
namespace {

using test::input_error;
using test::TempDir;

TEST(Statistics, SmallListByHand) {
  const ErrorStatistics s = statistics({4.0, 1.0, 3.0, 2.0});
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.std, std::sqrt(1.25));
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s.min, 1.0);
  EXPECT_DOUBLE_EQ(s.max, 4.0);
  EXPECT_DOUBLE_EQ(statistics({}).mean, 0.0);
  EXPECT_DOUBLE_EQ(statistics({7.0, 1.0, 2.0}).median, 2.0);
}

TEST(Relations, ErrorIsMeasuredInTheFirstPosesFrame) {
  // Facing up at (1, 1), then 2 m further up and turned left by 90 degrees.
  const std::vector<TimedPose> path = {{0.0, {1, 1, kPi / 2}}, {1.0, {1, 3, kPi}}};
  const std::vector<Relation> relations = {
      {0.0, 1.0, {2.0, 0.0, kPi / 2}},        // exact
      {0.0, 1.0, {2.0, 0.5, kPi / 2 - 0.1}},  // off by 0.5 m and 0.1 rad
      {0.0, 9.0, {0.0, 0.0, 0.0}},            // outside the path's time
  };
  const RelationErrors e = evaluate_relations(path, relations);
  EXPECT_EQ(e.used, 2u);
  EXPECT_EQ(e.total, 3u);
  EXPECT_NEAR(e.translation_m.mean, 0.25, 1e-12);
  EXPECT_NEAR(e.translation_m.std, 0.25, 1e-12);
  EXPECT_NEAR(e.translation_sqr_m2.mean, 0.125, 1e-12);
  EXPECT_NEAR(e.rotation_deg.max, 0.1 * 180.0 / kPi, 1e-9);
  EXPECT_EQ(cartographer_lines(e).substr(0, 45), "Abs translational error 0.25000 +/- 0.25000 m");
}

TEST(Relations, PosesAreInterpolatedAcrossShortGapsOnly) {
  // The heading goes through +-180 degrees the short way.
  const std::vector<TimedPose> path = {{0.0, {0, 0, kPi - 0.1}}, {1.0, {2, 0, -kPi + 0.1}}};
  const std::vector<Relation> half = {{0.0, 0.5, {-std::cos(0.1), -std::sin(0.1), 0.1}}};
  const RelationErrors near = evaluate_relations(path, half);
  EXPECT_EQ(near.used, 1u);
  EXPECT_NEAR(near.translation_m.max, 0.0, 1e-12);
  EXPECT_NEAR(near.rotation_deg.max, 0.0, 1e-9);
  EXPECT_EQ(evaluate_relations(path, half, 0.9).used, 0u);
}

TEST(Ate, RigidMotionOfTheWholePathCostsNothing) {
  const Pose2 T{3.0, -2.0, 2.5};
  std::vector<TimedPose> path, truth;
  for (int i = 0; i < 20; ++i) {
    path.push_back({0.5 * i, {0.3 * i, std::sin(0.4 * i), 0.0}});
    truth.push_back({0.5 * i, T * path.back().pose});
  }
  const AteResult ate = absolute_trajectory_error(associate(path, truth));
  EXPECT_EQ(ate.matched, 20u);
  EXPECT_NEAR(ate.error_m.max, 0.0, 1e-9);
  EXPECT_NEAR(ate.T_reference_map.x, T.x, 1e-9);
  EXPECT_NEAR(ate.T_reference_map.y, T.y, 1e-9);
  EXPECT_NEAR(ate.T_reference_map.theta, T.theta, 1e-9);
}

TEST(Ate, StretchedSquareByHand) {
  // Corners at (+-1, +-1) against (+-1.1, +-1): no rigid motion helps, each corner is 0.1 m off.
  const std::vector<TimedPose> path = {{0, {1, 1, 0}}, {1, {-1, 1, 0}}, {2, {-1, -1, 0}}, {3, {1, -1, 0}}};
  const std::vector<TimedPose> truth = {{0, {1.1, 1, 0}}, {1, {-1.1, 1, 0}}, {2, {-1.1, -1, 0}}, {3, {1.1, -1, 0}}};
  const AteResult ate = absolute_trajectory_error(associate(path, truth));
  EXPECT_NEAR(ate.error_m.rmse, 0.1, 1e-12);
  EXPECT_NEAR(ate.error_m.min, 0.1, 1e-12);
}

TEST(Ate, NeedsACommonClock) {
  const std::vector<TimedPose> path = {{0, {}}, {1, {}}}, truth = {{100, {}}, {101, {}}};
  EXPECT_NE(input_error([&] { absolute_trajectory_error(associate(path, truth)); }).find("clock"), std::string::npos);
}

TEST(Ate, StampsAreAssociatedAsEvoDoes) {
  // The reference is the shorter list, a few milliseconds off; one of its stamps has no partner.
  const std::vector<TimedPose> path = {{0.0, {0, 0, 0}}, {0.5, {1, 0, 0}}, {1.0, {2, 0, 0}}, {1.5, {3, 0, 0}}};
  const std::vector<TimedPose> truth = {{0.004, {0, 0, 0}}, {1.008, {2, 0, 0}}, {1.6, {9, 9, 0}}};
  const PosePairs pairs = associate(path, truth);
  EXPECT_FALSE(pairs.interpolated);
  ASSERT_EQ(pairs.ours.size(), 2u);
  EXPECT_EQ(pairs.ours[1].x, 2.0);
  const std::vector<TimedPose> between = {{0.25, {0.5, 0, 0}}, {0.75, {1.5, 0, 0}}, {1.25, {2.5, 0, 0}}};
  const PosePairs interpolated = associate(path, between);
  EXPECT_TRUE(interpolated.interpolated);
  EXPECT_EQ(interpolated.ours.size(), 2u) << "the stamps inside the reference";
  EXPECT_NEAR(absolute_trajectory_error(interpolated).error_m.max, 0.0, 1e-12);
}

TEST(Rpe, OneWrongStepByHand) {
  const std::vector<TimedPose> truth = {{0, {0, 0, 0}}, {1, {1, 0, 0}}, {2, {2, 0, kPi / 2}}, {3, {2, 1, kPi / 2}}};
  std::vector<TimedPose> path = truth;
  path[2].pose = {2.1, 0.0, kPi / 2};  // 0.1 m too far; the step after it is 0.1 m too far to the side
  const RpeResult rpe = relative_pose_error(associate(path, truth));
  EXPECT_EQ(rpe.matched, 3u);
  EXPECT_NEAR(rpe.translation_m.max, 0.1, 1e-12);
  EXPECT_NEAR(rpe.translation_m.min, 0.0, 1e-12);
  EXPECT_NEAR(rpe.translation_m.rmse, 0.1 * std::sqrt(2.0 / 3.0), 1e-12);
  EXPECT_NEAR(rpe.rotation_deg.max, 0.0, 1e-9);
}

TEST(TrajectoryFiles, TumComesBackAndBothFormatsAreToldApart) {
  const TempDir dir;
  const std::vector<TimedPose> path = {{10.5, {1.25, -2.5, 3.0}}, {11.0, {0.0, 4.0, -1.5}}};
  save_tum(path, dir / "path.tum");
  const auto back = load_trajectory(dir / "path.tum");
  const auto plain = load_trajectory(dir.write("path.txt", "# t x y theta\n11 0 4 -1.5\r\n\n10.5 1.25 -2.5 3\n"));
  for (const auto& read : {back, plain}) {
    ASSERT_EQ(read.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(read[i].t, path[i].t, 1e-6);
      EXPECT_NEAR(read[i].pose.x, path[i].pose.x, 1e-6);
      EXPECT_NEAR(read[i].pose.y, path[i].pose.y, 1e-6);
      EXPECT_NEAR(read[i].pose.theta, path[i].pose.theta, 1e-6);
    }
  }
}

TEST(TrajectoryFiles, BadOnesNameTheLine) {
  const TempDir dir;
  const auto bad = [&](const std::string& text) {
    return input_error([&] { load_trajectory(dir.write("bad.txt", text)); });
  };
  EXPECT_NE(bad("0 1 2 3\n1 2 3\n").find("bad.txt:2"), std::string::npos);
  EXPECT_NE(bad("0 1 2 x\n").find("bad.txt:1"), std::string::npos);
  EXPECT_NE(bad("0 1 2 nan\n").find("bad.txt:1"), std::string::npos);
  EXPECT_NE(bad("0 1 2 0 0 0 0 0\n").find("quaternion"), std::string::npos);
  EXPECT_NE(bad("# nothing\n").find("no pose"), std::string::npos);
  EXPECT_NE(input_error([&] { load_trajectory(dir / "none.txt"); }).find("no such file"), std::string::npos);
  const auto relations = dir.write("bad.relations", "0 1 0 0 0 0 0 0\n0 1 2\n");
  EXPECT_NE(input_error([&] { load_relations(relations); }).find("bad.relations:2"), std::string::npos);
  EXPECT_ANY_THROW(save_tum({}, dir / "no/such/folder.tum"));
}

}  // namespace
}  // namespace outrider::slam_glue
