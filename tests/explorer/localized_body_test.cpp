// A mind that lives in a believed frame, above a body in the true one.

#include "explorer/localized_body.hpp"
#include "explorer/scan_mapper.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/simulator.hpp"

namespace outrider::explorer {
namespace {

/// A hall of 14 x 10 m with pillars of different sizes.
OccupancyGrid hall() {
  OccupancyGrid map({0.1, {0.0, 0.0}, 140, 100}, CellState::kFree);
  const auto block = [&](int x0, int y0, int x1, int y1) {
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) map[Cell{x, y}] = CellState::kOccupied;
  };
  block(0, 0, 140, 2), block(0, 98, 140, 100), block(0, 0, 2, 100), block(138, 0, 140, 100);
  block(40, 40, 50, 46), block(90, 35, 93, 60), block(60, 70, 78, 74), block(20, 75, 28, 80), block(110, 75, 118, 90);
  return map;
}

struct Error {
  double most_m = 0.0, last_m = 0.0;
  bool arrived = false;
};

/// Drives three times round the hall in the believed frame.
Error drive(Localization localization, std::uint64_t seed) {
  const OccupancyGrid truth = hall();
  RobotSpec spec{.name = "a", .start = {2.0, 2.0, 0.0}, .speed = 1.0, .range = 12.0, .beams = 181};
  sim::SimOptions options;
  options.lidar = true;
  options.range_noise = 0.01;
  sim::Simulator simulator(truth, {spec}, options);
  LocalizedBody body(simulator.body(0), spec,
                     localization == Localization::kSlam ? make_pose_tracking(spec) : PoseTracking(), {}, seed);
  Error error;
  body.sense();
  std::vector<Point> way;
  for (int round = 0; round < 3; ++round) way.insert(way.end(), {{12, 2}, {12, 6.5}, {10.4, 6.5}, {10, 8.5}, {1.2, 8.5}, {1.2, 2}});
  body.follow(way);
  for (int step = 0; step < 1300 && !error.arrived; ++step) {
    simulator.step();
    const Sensing& sensing = body.sense();
    error.arrived = sensing.arrived;
    error.last_m = distance(sensing.pose.position(), simulator.pose(0).position());
    error.most_m = std::max(error.most_m, error.last_m);
  }
  return error;
}

TEST(LocalizedBody, ScanMatchingHoldsThePoseThatWheelsLose) {
  double by_wheels = 0.0;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const Error slam = drive(Localization::kSlam, seed);
    EXPECT_TRUE(slam.arrived) << "seed " << seed;
    EXPECT_LT(slam.most_m, 0.15) << "seed " << seed;
    by_wheels = std::max(by_wheels, drive(Localization::kOdometry, seed).most_m);
  }
  EXPECT_GT(by_wheels, 0.3) << "the noise is worth correcting";
}

TEST(LocalizedBody, SameSeedSameDrive) {
  EXPECT_EQ(drive(Localization::kSlam, 5).last_m, drive(Localization::kSlam, 5).last_m);
}

}  // namespace
}  // namespace outrider::explorer
