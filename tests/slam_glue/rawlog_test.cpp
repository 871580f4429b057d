// Rawlogs are read completely or refused; and SLAM over one gives the same map twice.

#include <random>

#include "slam_glue/files.hpp"
#include "slam_glue/slam.hpp"

namespace outrider::slam_glue {
namespace {

using test::input_error;
using test::TempDir;

class PackagedRawlog : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT(test::packaged_rawlog());
    bytes_ = test::bytes_of(test::packaged_rawlog());
  }
  std::string error_of(const std::string& bytes) const {
    const auto file = dir_.write("bad.rawlog", bytes);
    return input_error([&] { LogReader reader(file); });
  }

  TempDir dir_;
  std::string bytes_;
};

TEST_F(PackagedRawlog, IsReadCompletely) {
  const LogReader reader(test::packaged_rawlog());
  EXPECT_EQ(reader.info().format, "rawlog");
  EXPECT_EQ(reader.info().scans, 225u);
  EXPECT_NEAR(reader.info().duration_s(), 59.0, 1.0);
  EXPECT_TRUE(reader.info().has_odometry);
  double fraction = 0.0;
  std::size_t visited = 0;
  reader.read([&](const LogEntry& e, double f) {
    EXPECT_FALSE(e.scan.ranges.empty());
    EXPECT_GE(f, fraction);
    fraction = f;
    return ++visited < 10;
  });
  EXPECT_EQ(visited, 10u);  // stops when asked to
}

TEST_F(PackagedRawlog, TruncatedAnywhereIsRefused) {
  for (const std::size_t keep : {bytes_.size() - 1, bytes_.size() / 2, std::size_t{100}, std::size_t{5}}) {
    SCOPED_TRACE(keep);
    EXPECT_NE(error_of(bytes_.substr(0, keep)).find("bad.rawlog"), std::string::npos);
  }
}

TEST_F(PackagedRawlog, AFlippedByteIsRefused) {
  for (const std::size_t at : {bytes_.size() / 3, bytes_.size() / 2, bytes_.size() - 4}) {
    SCOPED_TRACE(at);
    std::string damaged = bytes_;
    damaged[at] = static_cast<char>(damaged[at] ^ 0x55);
    EXPECT_NE(error_of(damaged).find("bad.rawlog"), std::string::npos);
  }
}

TEST_F(PackagedRawlog, SameSeedSameMap) {
  for (const char* method : {"icp", "rbpf"}) {
    SCOPED_TRACE(method);
    SlamOptions options;
    options.method = method;
    options.resolution = 0.1;
    options.particles = 3;
    const auto run = [&] {
      const std::filesystem::path log = test::packaged_rawlog();
      return run_slam({&log, 1}, options, {}, [](const SlamProgress& p) { return p.scans < 40; });
    };
    const TeamSlamResult a = run(), b = run();
    EXPECT_TRUE(a.interrupted);
    EXPECT_EQ(a.logs[0].scans, 40u);
    EXPECT_EQ(a.logs[0].trajectory, b.logs[0].trajectory);
    EXPECT_EQ(a.team.mapper->states(), b.team.mapper->states());
    a.team.mapper->save(dir_ / "a.gridmap");
    b.team.mapper->save(dir_ / "b.gridmap");
    EXPECT_EQ(test::bytes_of(dir_ / "a.gridmap"), test::bytes_of(dir_ / "b.gridmap"));
  }
}

TEST(Rawlog, GarbageAndEmptyFilesAreRefused) {
  const TempDir dir;
  std::mt19937 random(7);
  std::string garbage;
  for (int i = 0; i < 20'000; ++i) garbage += static_cast<char>(random() & 0xFF);
  const std::string object =
      "\x8F"
      "CSensoryFrame12";
  for (const std::string& bytes : {std::string(), garbage, object + garbage}) {
    SCOPED_TRACE(bytes.size());
    const auto file = dir.write("x.rawlog", bytes);
    EXPECT_NE(input_error([&] { LogReader reader(file); }).find("x.rawlog"), std::string::npos);
  }
  EXPECT_NE(input_error([&] { LogReader reader(dir / "none.rawlog"); }).find("no such file"), std::string::npos);
}

TEST(Slam, UnknownMethodIsNamedWithASuggestion) {
  SlamOptions options;
  options.method = "ipc";
  const std::filesystem::path log = "log";
  EXPECT_NE(input_error([&] { run_slam({&log, 1}, options); }).find("icp"), std::string::npos);
}

TEST(Slam, CsailStaysNearItsRelations) {
  // Scan matching as published (Kuemmerle et al. 2009) is at 0.106 m; a first part keeps the test quick.
  const std::filesystem::path file = test::shared_log("csail/csail.clf.gz");
  SKIP_WITHOUT(file);
  SlamOptions options;
  options.resolution = 0.2;
  const TeamSlamResult r = run_slam({&file, 1}, options, {}, [](const SlamProgress& p) { return p.scans < 500; });
  EXPECT_EQ(r.logs[0].scans, 500u);
  EXPECT_TRUE(r.logs[0].warnings.empty());
  EXPECT_GT(r.team.consistency.end_points_agree, 0.85);
}

}  // namespace
}  // namespace outrider::slam_glue
