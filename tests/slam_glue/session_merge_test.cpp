// Several logs of one place become one map; logs of different places do not.

#include "slam_glue/session_merge.hpp"

#include <gtest/gtest.h>

#include "slam_glue/files.hpp"
#include "slam_glue/graph_slam.hpp"
#include "slam_glue/segment_world.hpp"
#include "slam_glue/split_log.hpp"

namespace outrider::slam_glue {
namespace {

/// A ring like test::ring_world(), with other niches: another building of the same architect.
test::SegmentWorld other_building() {
  std::vector<test::Wall> walls;
  test::add_box(walls, 0.0, 0.0, 20.0, 14.0);
  test::add_box(walls, 2.0, 2.0, 18.0, 12.0);
  for (const auto& [x, y, w] : std::vector<std::array<double, 3>>{
           {2.5, 0, .7}, {7, 0, .3}, {15.5, 0, .9}, {3, 13.6, .4}, {8, 13.7, .8}, {13, 13.6, .6}})
    test::add_box(walls, x, y, x + w, y + 0.4);
  for (const auto& [x, y, w] : std::vector<std::array<double, 3>>{{0, 3, .8}, {0, 7, .3}, {19.7, 7, .8}, {19.6, 11, .3}})
    test::add_box(walls, x, y, x + 0.4, y + w);
  return test::SegmentWorld(walls);
}

struct Session {
  SessionGraph graph;
  std::vector<Pose2> truth;  ///< of the keyframes
};

/// Graph SLAM over the part [from, to) of the round trip.
Session drive(const test::SegmentWorld& world, double from, double to, unsigned seed) {
  const auto trip = test::round_trip();
  const auto n = static_cast<double>(trip.size());
  const std::vector<Pose2> poses(trip.begin() + static_cast<std::ptrdiff_t>(from * n),
                                 trip.begin() + static_cast<std::ptrdiff_t>(to * n));
  std::mt19937 random(seed);
  const auto scans = test::scans_along(world, poses, 181, kPi, random);
  const auto odometry = test::slipping_odometry(poses, 0.03, 0.03, 0.0, random);
  GraphSlam slam{GraphSettings{}};
  for (std::size_t i = 0; i < scans.size(); ++i) slam.add(scans[i], odometry[i]);
  slam.finish();
  Session session{{slam.graph(), slam.closures()}, {}};
  for (const Keyframe& frame : session.graph.graph.frames) session.truth.push_back(poses[frame.index]);
  return session;
}

double worst_error(const JointGraph& joint, const std::vector<Session>& sessions) {
  double worst = 0.0;
  const Pose2 T_world_map = sessions[0].truth[0] * inverse(joint.graph.poses[0]);
  for (std::size_t s = 0; s < sessions.size(); ++s)
    for (std::size_t k = 0; k < sessions[s].truth.size(); ++k) {
      const Pose2 ours = T_world_map * joint.graph.poses[joint.begin[s] + k];
      worst = std::max(worst, distance(ours.position(), sessions[s].truth[k].position()));
    }
  return worst;
}

JointGraph joint_of(const std::vector<Session>& sessions) {
  std::vector<SessionGraph> graphs;
  for (const Session& s : sessions) graphs.push_back(s.graph);
  return JointGraph(std::move(graphs));
}

TEST(SessionMerge, FindsTheTransformOfOverlappingDrives) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const auto world = test::ring_world();
    const std::vector<Session> sessions{drive(world, 0.0, 0.6, seed), drive(world, 0.4, 1.0, seed + 10)};
    JointGraph joint = joint_of(sessions);
    const auto records = merge_sessions(joint, false);
    ASSERT_EQ(records.size(), 1u);
    // Turned by half a turn the ring looks much alike: refusing it is right, a wrong placement is not.
    if (records[0].accepted) {
      EXPECT_LT(worst_error(joint, sessions), 0.25) << "seed " << seed;
    }
  }
}

TEST(SessionMerge, RefusesWithoutCommonGroundAndSaysWhy) {
  const auto world = test::ring_world(), other = other_building();
  const std::vector<std::vector<Session>> pairs{{drive(world, 0.0, 1.0, 3), drive(other, 0.0, 1.0, 4)}};
  for (const auto& sessions : pairs) {
    JointGraph joint = joint_of(sessions);
    const std::vector<Pose2> before = joint.graph.poses;
    const auto records = merge_sessions(joint, false);
    EXPECT_FALSE(records[0].accepted);
    EXPECT_FALSE(records[0].why.empty());
    EXPECT_EQ(joint.graph.poses, before) << "a refused log stays as it was";
  }
}

/// Sides of the ring, each seen by one log only: walls and corners fit, the pillars of 0.3 to 0.4 m do not, and no
/// rival placement warns. Right would be side by side; refused is the least.
TEST(SessionMerge, RefusesSidesThatLookAlike) {
  const auto world = test::ring_world();
  struct Side {
    double from, to;
  };
  const std::vector<std::pair<Side, Side>> pairs{{{0.0, 0.3}, {0.45, 0.7}},    // bottom, top
                                                 {{0.02, 0.21}, {0.42, 0.6}},  // the same, without their corners
                                                 {{0.24, 0.4}, {0.63, 0.8}}};  // right, left
  for (const auto& [a, b] : pairs)
    for (unsigned seed = 1; seed <= 3; ++seed) {
      const std::vector<Session> sessions{drive(world, a.from, a.to, seed), drive(world, b.from, b.to, seed + 10)};
      JointGraph joint = joint_of(sessions);
      const MergeRecord record = merge_sessions(joint, false)[0];
      if (record.accepted) {
        EXPECT_LT(worst_error(joint, sessions), 0.25)
            << a.from << " and " << b.from << " seed " << seed << ": missing " << record.missing;
      } else {
        EXPECT_FALSE(record.why.empty());
      }
    }
}

TEST(SessionMerge, KnownStartsAreHeldAgainstTheScans) {
  const auto world = test::ring_world();
  const std::vector<Session> sessions{drive(world, 0.0, 0.6, 5), drive(world, 0.4, 1.0, 6)};
  const Pose2 start = inverse(sessions[0].truth[0]) * sessions[1].truth[0];
  JointGraph right = joint_of(sessions);
  right.move(1, start * Pose2{0.2, -0.2, 0.05});
  EXPECT_TRUE(merge_sessions(right, true)[0].accepted);
  EXPECT_LT(worst_error(right, sessions), 0.25);
  JointGraph wrong = joint_of(sessions);
  wrong.move(1, start * Pose2{6.0, 1.0, 0.6});
  const MergeRecord record = merge_sessions(wrong, true)[0];
  EXPECT_FALSE(record.accepted);
  EXPECT_NE(record.why.find("start"), std::string::npos) << record.why;
}

/// Real logs: the halves of one run fit together, runs of different buildings do not.
TEST(SessionMerge, HalvesOfARealRunAndOtherBuildings) {
  const std::filesystem::path seattle = test::shared_log("corrected/seattle-corrected.log.gz"),
                              wean = test::shared_log("wean/wean1.clf.gz");
  SKIP_WITHOUT(seattle);
  SKIP_WITHOUT(wean);
  SlamOptions options;
  options.resolution = 0.2;
  const test::TempDir dir;
  const auto different = run_slam(std::vector<std::filesystem::path>{wean, seattle}, options, {{}, true});
  EXPECT_FALSE(different.merges[0].accepted);
  EXPECT_FALSE(different.logs[1].in_team_map);
  const auto halves = test::split_log(wean, 2, 0.3, dir / "wean");
  const auto one = run_slam(std::vector<std::filesystem::path>{wean}, options);
  const auto two = run_slam(halves, options, {{}, true});
  if (!two.merges[0].accepted) return;  // refused is allowed, wrong is not
  // Where the second half starts, by the undivided run.
  const TimedPose& start = two.logs[1].trajectory.front();
  for (const TimedPose& p : one.logs[0].trajectory)
    if (p.t == start.t) {
      EXPECT_LT(distance(p.pose.position(), start.pose.position()), 0.5);
    }
}

}  // namespace
}  // namespace outrider::slam_glue
