// CARMEN logs: every trap on a log of a few lines, and the logs that others recorded where they are at hand.

#include <fmt/format.h>
#include <zlib.h>

#include "slam_glue/files.hpp"
#include "slam_glue/logs.hpp"

namespace outrider::slam_glue {
namespace {

using test::input_error;
using test::TempDir;

std::string repeat(const std::string& word, std::size_t n) {
  std::string text;
  for (std::size_t i = 0; i < n; ++i) text += word + ' ';
  return text;
}

std::string flaser(std::size_t beams, const std::string& times, const std::string& laser = "0 0 0",
                   const std::string& robot = "0 0 0") {
  return fmt::format("FLASER {} {}{} {} {}\n", beams, repeat("1.5", beams), laser, robot, times);
}

std::string robotlaser(const std::string& angles, const std::string& times, const std::string& laser = "0.2 0 0",
                       const std::string& robot = "0 0 0") {
  return fmt::format("ROBOTLASER1 0 {} 80.0 0.01 0 3 1.0 2.0 3.0 0 {} {} 0 0 0 0 0 {}\n", angles, laser, robot, times);
}

std::vector<LogEntry> entries_of(const std::filesystem::path& file) {
  std::vector<LogEntry> entries;
  read_log(file, [&](const LogEntry& e, double) { return entries.push_back(e), true; });
  return entries;
}

std::vector<LogEntry> parse(const std::string& text) {
  const TempDir dir;
  return entries_of(dir.write("log.clf", text));
}

std::string parse_error(const std::string& text) {
  return input_error([&] { parse(text); });
}

TEST(Carmen, FieldOfViewFollowsFromTheNumberOfBeams) {
  for (const std::size_t beams : {180, 181, 360, 361}) {
    SCOPED_TRACE(beams);
    const auto log = parse(flaser(beams, "1.0 host 0.5"));
    ASSERT_EQ(log.size(), 1u);
    const LaserScan& scan = log[0].scan;
    EXPECT_EQ(scan.ranges.size(), beams);
    EXPECT_DOUBLE_EQ(scan.angle_min, -kPi / 2);
    // 180 beams are 181 without the last: one degree apart, never 90 degrees wide.
    EXPECT_NEAR(scan.angle_increment, kPi / (beams < 300 ? 180.0 : 360.0), 1e-12);
  }
}

TEST(Carmen, RobotLaserStatesItsOwnAngles) {
  const auto log = parse(robotlaser("-0.5 1.0 0.5", "1.0 host 0.5"));
  ASSERT_EQ(log.size(), 1u);
  EXPECT_DOUBLE_EQ(log[0].scan.angle_min, -0.5);
  EXPECT_DOUBLE_EQ(log[0].scan.angle_increment, 0.5);
  EXPECT_DOUBLE_EQ(log[0].scan.range_max, 80.0);
}

TEST(Carmen, KeepsTheLogsOwnTimes) {
  const auto log = parse(flaser(3, "1134864642.91419 host 3.5") + flaser(3, "1134864643.12418 host 3.7"));
  ASSERT_EQ(log.size(), 2u);
  EXPECT_NEAR(log[0].scan.t, 1134864642.91419, 1e-6);
  EXPECT_NEAR(log[1].scan.t, 1134864643.12418, 1e-6);
}

TEST(Carmen, LoggersClockWhenTheSensorsStandsStill) {
  std::string text;
  for (int i = 0; i < 10; ++i) text += flaser(3, fmt::format("5 host {:.1f}", 2.0 + 0.1 * i));
  const auto log = parse(text);
  ASSERT_EQ(log.size(), 10u);
  EXPECT_NEAR(log[9].scan.t - log[0].scan.t, 0.9, 1e-9);
}

TEST(Carmen, ASweepUnderThreeNamesIsOneScan) {
  std::string text = "PARAM robot_front_laser_max 81.9\nNMEAGGA nonsense\n";
  for (int i = 1; i <= 4; ++i) {
    const std::string times = fmt::format("{}.0 host {}.0", i, i);
    text += fmt::format("ODOM {} 0 0 0 0 0 {}\n", i, times);
    text += fmt::format("RAWLASER1 0 -1.5708 3.14159 0.0087 81.9 0.01 0 3 1 2 3 0 {}\n", times);
    text += robotlaser("-1 2 1", times);
    text += flaser(3, times);
  }
  EXPECT_EQ(parse(text).size(), 4u);
}

TEST(Carmen, FixedLaserOffsetIsTheMounting) {
  // The robot looks up at (1, 2); the laser sits 0.2 m ahead of its centre.
  const auto log = parse(robotlaser("-1 2 1", "1 host 1", "1 2.2 1.5707963", "1 2 1.5707963") +
                         robotlaser("-1 2 1", "2 host 2", "1.2 2 0", "1 2 0"));
  ASSERT_EQ(log.size(), 2u);
  EXPECT_NEAR(log[0].scan.T_robot_sensor.x, 0.2, 1e-6);
  EXPECT_NEAR(log[0].scan.T_robot_sensor.y, 0.0, 1e-6);
  EXPECT_FALSE(log[0].logged_pose);
}

TEST(Carmen, CorrectedPosesAreNoMounting) {
  const auto log = parse(flaser(3, "1 host 1", "0 0 0", "0 0 0") + flaser(3, "2 host 2", "1 0.3 0.1", "1 0 0"));
  ASSERT_EQ(log.size(), 2u);
  EXPECT_EQ(log[1].scan.T_robot_sensor, Pose2{});
  EXPECT_EQ(log[1].odometry, (Pose2{1.0, 0.0, 0.0}));
  ASSERT_TRUE(log[1].logged_pose);
  EXPECT_NEAR(log[1].logged_pose->y, 0.3, 1e-9);
}

TEST(Carmen, SickErrorCodesAreNoEcho) {
  const auto log = parse("FLASER 3 1.0 81.83 nan 0 0 0 0 0 0 1 host 1\n");
  ASSERT_EQ(log.size(), 1u);
  EXPECT_TRUE(log[0].scan.valid(0));
  EXPECT_FALSE(log[0].scan.valid(1));
  EXPECT_FALSE(log[0].scan.valid(2));
}

TEST(Carmen, PlainGzipAndDosLinesReadAlike) {
  const TempDir dir;
  std::string text = "# a comment\r\n\r\n" + flaser(5, "1 host 1") + flaser(5, "2 host 2");
  const auto plain = entries_of(dir.write("a.log", text));
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2)
    if (at == 0 || text[at - 1] != '\r')
      text.insert(at, 1, '\r');
    else
      --at;
  text.pop_back(), text.pop_back();  // nor does the last line need an end
  const std::string name = dir / "b.log.gz";
  gzFile gz = gzopen(name.c_str(), "wb");
  gzwrite(gz, text.data(), static_cast<unsigned>(text.size()));
  gzclose(gz);
  const auto packed = entries_of(name);
  ASSERT_EQ(plain.size(), 2u);
  ASSERT_EQ(packed.size(), 2u);
  EXPECT_EQ(plain[1].scan.ranges, packed[1].scan.ranges);
  EXPECT_EQ(plain[1].scan.t, packed[1].scan.t);

  const std::string bytes = test::bytes_of(name);
  const auto cut = dir.write("cut.log.gz", bytes.substr(0, bytes.size() - 6));
  EXPECT_NE(input_error([&] { entries_of(cut); }).find("cut.log.gz"), std::string::npos);
}

TEST(Carmen, DamageIsRefusedWithItsLine) {
  const std::string good = flaser(3, "1 host 1");
  EXPECT_NE(parse_error(good + "FLASER 3 1.0 2.0\n").find("log.clf:2"), std::string::npos);
  EXPECT_NE(parse_error(good + "FLASER 3 1.0 2.0 x 0 0 0 0 0 0 1 h 1\n").find("log.clf:2"), std::string::npos);
  EXPECT_NE(parse_error("FLASER 4000000000 1.0\n").find("number of beams"), std::string::npos);
  EXPECT_NE(parse_error("FLASER -1 1.0\n").find("number of beams"), std::string::npos);
  EXPECT_NE(parse_error("FLASER 0 0 0 0 0 0 0 1 h 1\n").find("number of beams"), std::string::npos);
  EXPECT_NE(parse_error("FLASER 1 1.0 inf 0 0 0 0 0 1 h 1\n").find("log.clf:1"), std::string::npos);
  EXPECT_NE(parse_error("").find("empty"), std::string::npos);
  EXPECT_NE(parse_error("# only a comment\nODOM 0 0 0 0 0 0 1 h 1\n").find("no laser scan"), std::string::npos);
  EXPECT_NE(parse_error(std::string("FLASER\0 3", 9)).find("not text"), std::string::npos);
}

TEST(Carmen, MissingFilesAndFoldersAreNamed) {
  const TempDir dir;
  EXPECT_NE(input_error([&] { entries_of(dir / "no.log"); }).find("no such file"), std::string::npos);
  EXPECT_NE(input_error([&] { entries_of(dir / "."); }).find("directory"), std::string::npos);
}

TEST(Carmen, CsailsTripledOriginalHolds1988Scans) {
  const auto file = test::shared_log("csail/original.flaser.log.gz");
  SKIP_WITHOUT(file);
  const LogReader reader(file);
  EXPECT_EQ(reader.info().scans, 1988u);
  EXPECT_NEAR(reader.info().duration_s(), 424.0, 1.0);
  EXPECT_TRUE(reader.info().has_odometry);
}

}  // namespace
}  // namespace outrider::slam_glue
