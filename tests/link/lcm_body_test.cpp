// A real body's messages: bot_core's fingerprints and what is made of them.

#include "link/lcm_body.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

namespace outrider::link {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put(Bytes& out, std::uint64_t value, unsigned bytes) {
  for (unsigned k = bytes; k-- > 0;) out.push_back(static_cast<std::uint8_t>(value >> (8U * k)));
}
void put_float(Bytes& out, float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put(out, bits, 4);
}
void put_double(Bytes& out, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  put(out, bits, 8);
}

// Of bot_core's definitions by lcm-gen 1.3.1; whoever changes a member's name, type or place changes these.
constexpr std::uint64_t kLidarFingerprint = 0xe3d17423180b5e8d, kPoseFingerprint = 0x2e16efb052b0105e;

Bytes lidar(std::uint32_t beams, std::uint32_t declared) {
  Bytes out;
  put(out, kLidarFingerprint, 8);
  put(out, 2500000, 8);
  put(out, declared, 4);
  for (std::uint32_t k = 0; k < beams; ++k) put_float(out, 1.0F + static_cast<float>(k));
  put(out, 0, 4);
  put_float(out, -1.5F);
  put_float(out, 0.25F);
  return out;
}

TEST(LcmBody, AScanOfBotCoreIsUnderstood) {
  const auto scan = parse_planar_lidar(lidar(10, 10), 8.0);
  ASSERT_TRUE(scan);
  EXPECT_DOUBLE_EQ(scan->t, 2.5);
  EXPECT_FLOAT_EQ(static_cast<float>(scan->angle_min), -1.5F);
  EXPECT_FLOAT_EQ(static_cast<float>(scan->angle_increment), 0.25F);
  ASSERT_EQ(scan->ranges.size(), 10U);
  EXPECT_FLOAT_EQ(scan->ranges[3], 4.0F);
  EXPECT_FALSE(scan->valid(8)) << "beyond the range";
}

TEST(LcmBody, LengthsThatLieAreRefused) {
  for (const std::uint32_t declared : {0U, 1U, 9U, 11U, 0x7FFFFFFFU, 0x80000000U, 0xFFFFFFFFU, 0x40000000U})
    EXPECT_FALSE(parse_planar_lidar(lidar(10, declared), 8.0)) << declared;
  const Bytes whole = lidar(10, 10);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(parse_planar_lidar(std::span(whole).first(size), 8.0)) << size;
}

TEST(LcmBody, APoseOfBotCoreIsUnderstood) {
  Bytes out;
  put(out, kPoseFingerprint, 8);
  put(out, 1, 8);
  for (const double v : {1.0, 2.0, 0.0, 0.0, 0.0, 0.0, std::cos(0.5), 0.0, 0.0, std::sin(0.5)}) put_double(out, v);
  for (int k = 0; k < 6; ++k) put_double(out, 0.0);
  const auto pose = parse_pose(out);
  ASSERT_TRUE(pose);
  EXPECT_DOUBLE_EQ(pose->x, 1.0);
  EXPECT_DOUBLE_EQ(pose->y, 2.0);
  EXPECT_NEAR(pose->theta, 1.0, 1e-12);
  out.pop_back();
  EXPECT_FALSE(parse_pose(out));
}

TEST(LcmBody, PursuitEndsAtTheEndOfThePath) {
  std::vector<Point> path{{1.0, 0.0}, {2.0, 0.0}, {2.0, 1.5}};
  const Point end = path.back();
  Pose2 pose{0.0, 0.3, 2.0};
  for (int k = 0; k < 1000; ++k) {
    const Velocity v = pursue(pose, path, 0.5, 0.15);
    pose.theta += 0.05 * v.angular;
    pose.x += 0.05 * v.linear * std::cos(pose.theta);
    pose.y += 0.05 * v.linear * std::sin(pose.theta);
  }
  EXPECT_LE(distance(pose.position(), end), 0.15);
  EXPECT_TRUE(path.empty());
  EXPECT_EQ(pursue(pose, path, 0.5, 0.15).angular, 0.0);
}

}  // namespace
}  // namespace outrider::link
