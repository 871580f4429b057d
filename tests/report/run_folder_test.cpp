#include "report/run_folder.hpp"

#include <gtest/gtest.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <map>
#include <sstream>

#include "records.hpp"
#include "world/error.hpp"

namespace outrider::report {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

/// Relative path -> content of every file below `dir`.
std::map<std::string, std::string> contents(const fs::path& dir) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(dir))
    if (entry.is_regular_file()) files[fs::relative(entry.path(), dir).string()] = read(entry.path());
  return files;
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& e) {
    return e.what();
  }
  return "(nothing thrown)";
}

class RunFolder : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "outrider-report-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    root_ = name;
  }
  void TearDown() override { fs::remove_all(root_); }
  bool root_is_empty() const { return fs::is_empty(root_); }

  fs::path root_;
};

TEST_F(RunFolder, HoldsWhatIsDocumented) {
  const fs::path dir = root_ / "a" / "run";  // parents are made
  write_run_folder(small_record(), dir, {}, [](const fs::path& staging) { write_file(staging / "map.yaml", "m"); });
  EXPECT_EQ(read(dir / "map.yaml"), "m");
  EXPECT_EQ(read(dir / "timeline.csv"),
            "time_s,explored_fraction,explored_m2,alice_m2,bob_m2\n"
            "0.000,0.250000,2.0000,1.0000,1.0000\n"
            "1.000,0.750000,6.0000,4.0000,2.0000\n");
  EXPECT_EQ(read(dir / "events.jsonl"),
            "{\"t\":0.0,\"event\":\"goal\",\"robot\":\"alice\",\"goal\":[3.5,0.5]}\n"
            "{\"t\":0.5,\"event\":\"auction\",\"bids\":[{\"robot\":\"bob\",\"value\":3.5}]}\n");
  EXPECT_EQ(read(dir / "trajectories" / "alice.tum"),
            "0.000000 0.500000 0.500000 0 0 0 0.000000000 1.000000000\n"
            "1.000000 3.500000 0.500000 0 0 0 0.000000000 1.000000000\n");
  EXPECT_TRUE(fs::exists(dir / "report.html"));
  const Json run = Json::parse(read(dir / "run.json"));
  for (const char* key : {"schema", "outrider", "command", "seed", "world", "team", "coordinator", "comms",
                          "configuration", "result", "timing"})
    EXPECT_TRUE(run.contains(key)) << key;
  EXPECT_EQ(run["schema"], 1);
  EXPECT_EQ(run["seed"], 7);
  EXPECT_EQ(run["team"][1]["name"], "bob");
  EXPECT_EQ(std::distance(fs::directory_iterator(root_ / "a"), {}), 1) << "no staging directory is left behind";
}

TEST_F(RunFolder, EqualRecordsGiveEqualBytesApartFromTiming) {
  RunRecord record = small_record();
  write_run_folder(record, root_ / "one", {}, nullptr);
  record.timing = {{"wall_s", 99.0}};
  write_run_folder(record, root_ / "two", {}, nullptr);
  auto one = contents(root_ / "one"), two = contents(root_ / "two");
  Json run_one = Json::parse(one["run.json"]), run_two = Json::parse(two["run.json"]);
  run_one.erase("timing");
  run_two.erase("timing");
  EXPECT_EQ(run_one, run_two);
  one.erase("run.json");
  two.erase("run.json");
  EXPECT_EQ(one, two);
}

TEST_F(RunFolder, RefusesAFolderThatIsNotEmpty) {
  fs::create_directory(root_ / "full");
  write_file(root_ / "full" / "thesis.tex", "");
  EXPECT_THROW(check_out_dir(root_ / "full", false), InputError);
  EXPECT_THROW(write_run_folder(small_record(), root_ / "full", {}, nullptr), InputError);
  EXPECT_NE(message_of([&] { check_out_dir(root_ / "full", false); }).find("thesis.tex"), std::string::npos);
  EXPECT_THROW(check_out_dir(root_ / "full" / "thesis.tex", false), InputError) << "a file";
  EXPECT_THROW(check_out_dir(root_ / "full" / "thesis.tex" / "run", true), InputError) << "below a file";
  fs::create_directory(root_ / "empty");
  EXPECT_NO_THROW(check_out_dir(root_ / "empty", false));
  EXPECT_NO_THROW(check_out_dir(root_ / "not" / "yet" / "there", false));
  EXPECT_FALSE(fs::exists(root_ / "not")) << "a check creates nothing";
}

TEST_F(RunFolder, ForceReplacesTheRunAndKeepsOtherFiles) {
  const fs::path dir = root_ / "run";
  write_run_folder(small_record(), dir, {}, [](const fs::path& staging) { write_file(staging / "map.bt", "old"); });
  write_file(dir / "notes.txt", "mine");
  RunRecord record = small_record();
  record.seed = 8;
  write_run_folder(record, dir, {.force = true}, nullptr);
  EXPECT_EQ(Json::parse(read(dir / "run.json"))["seed"], 8);
  EXPECT_FALSE(fs::exists(dir / "map.bt")) << "of the old run";
  EXPECT_EQ(read(dir / "notes.txt"), "mine");
}

TEST_F(RunFolder, AnErrorOnTheWayLeavesNothingAndKeepsTheOldRun) {
  const auto broken = [](const fs::path&) { throw std::runtime_error("no maps today"); };
  EXPECT_EQ(message_of([&] { write_run_folder(small_record(), root_ / "run", {}, broken); }), "no maps today");
  EXPECT_TRUE(root_is_empty());
  write_run_folder(small_record(), root_ / "run", {}, nullptr);
  const auto before = contents(root_ / "run");
  EXPECT_THROW(write_run_folder(small_record(), root_ / "run", {.force = true}, broken), std::runtime_error);
  EXPECT_EQ(contents(root_ / "run"), before);
}

TEST_F(RunFolder, NamesThatLeaveTheFolderAreRefused) {
  for (const std::string name : {"../evil", "a/b", "", ".."}) {
    SCOPED_TRACE(name);
    RunRecord record = small_record();
    record.robots[0].spec.name = name;
    EXPECT_THROW(write_run_folder(record, root_ / "run", {}, nullptr), InputError);
  }
  EXPECT_TRUE(root_is_empty());
}

/// Runs `child` in a process of its own; its exit status.
int in_child(const std::function<int()>& child) {
  const pid_t pid = fork();
  if (pid == 0) _exit(child());
  int status = 0;
  waitpid(pid, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

TEST_F(RunFolder, AFileSizeLimitLeavesNothing) {
  const int status = in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{4096, 4096};  // report.html does not fit
    setrlimit(RLIMIT_FSIZE, &limit);
    const std::string message = message_of([&] { write_run_folder(small_record(), root_ / "run", {}, nullptr); });
    return message.find("report.html: File too large") != std::string::npos ? 0 : 1;
  });
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(root_is_empty());
}

constexpr int kNoMount = 77;

/// Writes a run into `place`, a path on a new tmpfs of 64 kB mounted at `disk`. 0: failed as it should, nothing left.
int write_on_tiny_disk(const fs::path& disk, const fs::path& place) {
  if (unshare(CLONE_NEWNS) != 0 || mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return kNoMount;
  if (mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=64k") != 0) return kNoMount;
  const std::string message = message_of([&] { write_run_folder(small_record(), place, {}, nullptr); });
  if (message.find("No space left on device") == std::string::npos) return 1;
  return fs::is_empty(disk) ? 0 : 2;
}

TEST_F(RunFolder, AFullDiskLeavesNothing) {
  for (const char* place : {"run", ""}) {  // below the mount point, and the mount point itself
    SCOPED_TRACE(place);
    const int status = in_child([&] { return write_on_tiny_disk(root_, *place != '\0' ? root_ / place : root_); });
    if (status == kNoMount) GTEST_SKIP() << "mounting a tmpfs is not permitted here";
    EXPECT_EQ(status, 0);
  }
}

TEST_F(RunFolder, AMountPointIsFilledInPlace) {
  const int status = in_child([&] {
    if (unshare(CLONE_NEWNS) != 0 || mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0) return kNoMount;
    if (mount("tmpfs", root_.c_str(), "tmpfs", 0, "size=4m") != 0) return kNoMount;
    write_run_folder(small_record(), root_, {}, nullptr);
    return load_run(root_).timeline.size() == 2 && !fs::exists(root_ / "run") ? 0 : 1;
  });
  if (status == kNoMount) GTEST_SKIP() << "mounting a tmpfs is not permitted here";
  EXPECT_EQ(status, 0);
}

TEST_F(RunFolder, LoadsWhatWasWritten) {
  write_run_folder(small_record(), root_ / "run", {}, nullptr);
  const RunSummary run = load_run(root_ / "run/");
  EXPECT_EQ(run.name, "run");
  EXPECT_EQ(run.run, run_json(small_record()));
  ASSERT_EQ(run.timeline.size(), 2U);
  EXPECT_EQ(run.timeline[1].explored_fraction, 0.75);
  EXPECT_EQ(run.timeline[1].robot_m2, (std::vector<double>{4.0, 2.0}));
}

TEST_F(RunFolder, BrokenRunsAreNamed) {
  const fs::path dir = root_ / "run";
  EXPECT_THROW(load_run(dir), InputError) << "absent";
  fs::create_directory(dir);
  EXPECT_THROW(load_run(dir), InputError) << "no run.json";
  const auto broken = [&](const char* file, const std::string& text) {
    write_file(dir / file, text);
    EXPECT_THROW(load_run(dir), InputError);
    return message_of([&] { load_run(dir); });
  };
  EXPECT_NE(broken("run.json", "{\"schema\": 1,").find("run.json"), std::string::npos);
  EXPECT_NE(broken("run.json", "[]").find("'schema'"), std::string::npos);
  EXPECT_NE(broken("run.json", R"({"schema": 2})").find("'schema'"), std::string::npos);
  EXPECT_NE(broken("run.json", R"({"schema": 1})").find("'result'"), std::string::npos);
  EXPECT_NE(broken("run.json", R"({"schema": 1, "result": {}, "team": [], "comms": 3})").find("'comms'"),
            std::string::npos);
  write_file(dir / "run.json", R"({"schema": 1, "result": {}, "team": []})");
  EXPECT_NO_THROW(load_run(dir));
  const std::string header = "time_s,explored_fraction,explored_m2\n";
  EXPECT_NE(broken("timeline.csv", header + "1,2,3\n1,x,3\n").find("timeline.csv:3: expected a number, found 'x'"),
            std::string::npos);
  EXPECT_NE(broken("timeline.csv", header + "1,2\n").find("timeline.csv:2"), std::string::npos);
  EXPECT_NE(broken("timeline.csv", "a,b\n").find("timeline.csv:1"), std::string::npos);
}

}  // namespace
}  // namespace outrider::report
