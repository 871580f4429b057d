// Laying a map onto a true one, and judging a map by its own scans.

#include <gtest/gtest.h>

#include "slam_glue/consistency.hpp"
#include "slam_glue/grid_mapper.hpp"
#include "slam_glue/map_alignment.hpp"
#include "slam_glue/segment_world.hpp"

namespace outrider::slam_glue {
namespace {

/// The map of a drive round the ring, made with poses that are `shift` to the side in its last part.
struct Drive {
  OccupancyGrid map;
  SelfConsistency consistency;
};
Drive drive(const Pose2& T_map_world, double shift, double resolution) {
  const auto world = test::ring_world();
  const auto truth = test::round_trip();
  std::mt19937 random(3);
  const auto scans = test::scans_along(world, truth, 181, kPi, random);
  GridMapper mapper({resolution, {-30.0, -30.0}, static_cast<int>(60 / resolution), static_cast<int>(60 / resolution)});
  ConsistencyCheck check(20.0);
  std::vector<std::uint32_t> changed;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const bool late = 5 * i > 4 * scans.size();
    const Pose2 off = late ? Pose2{0.0, shift, 0.0} : Pose2{};
    const Pose2 T = T_map_world * off * truth[i];
    mapper.insert(scans[i], T, changed);
    if (i % 3 == 0) check.add(scans[i], T);
  }
  return {mapper.states(), check.result(mapper.states())};
}

TEST(MapAlignment, FindsATurnedMap) {
  const OccupancyGrid truth = drive({}, 0.0, 0.1).map;
  for (const Pose2 T_map_world : {Pose2{}, Pose2{3.0, -2.0, 0.4}, Pose2{-4.0, 9.0, -2.8}}) {
    const OccupancyGrid map = drive(T_map_world, 0.0, 0.05).map;
    const auto found = align_map(map, truth);
    ASSERT_TRUE(found);
    const Pose2 error = found->T_truth_map * T_map_world;
    EXPECT_LT(std::hypot(error.x, error.y), 0.06) << "turned by " << T_map_world.theta;
    EXPECT_LT(std::abs(error.theta), 0.01) << "turned by " << T_map_world.theta;
    EXPECT_GT(found->score, 0.85);
    EXPECT_LT(found->rival, found->score - 0.03) << "the ring turned by half a turn";
  }
}

TEST(MapAlignment, NothingToAlign) {
  const OccupancyGrid empty({0.1, {0.0, 0.0}, 10, 10}, CellState::kFree);
  EXPECT_FALSE(align_map(empty, empty));
}

TEST(SelfConsistency, ShiftedPosesAreSeen) {
  const SelfConsistency good = drive({}, 0.0, 0.05).consistency;
  EXPECT_GT(good.end_points_agree, 0.99);
  EXPECT_LT(good.seen_through, 0.01);
  EXPECT_LT(good.doubled_walls, 0.02);
  const SelfConsistency bad = drive({}, 0.35, 0.05).consistency;
  EXPECT_GT(bad.seen_through, good.seen_through + 0.02);
  EXPECT_GT(bad.doubled_walls, good.doubled_walls + 0.05);
}

}  // namespace
}  // namespace outrider::slam_glue
