// Whole live teams on this machine: real processes, real sockets, in a network namespace of the test's own.

#include <gtest/gtest.h>
#include <signal.h>

#include "live/rooms.hpp"

namespace outrider::test {
namespace {

class Live : public SystemTest {
 protected:
  void SetUp() override {
    if (!private_network()) GTEST_SKIP() << "this kernel gives no network namespace";
    SystemTest::SetUp();
    write_rooms_and_team(dir);
  }

  /// A team of four in the four rooms; its run.json.
  Json team(const Args& more, int expected_code = 0, const std::string& speed = "8") {
    Args args{"team", "rooms.txt", "--team", "team.yaml", "--json", "--speed", speed};
    args.insert(args.end(), more.begin(), more.end());
    const Outcome outcome = run(args, {.limit = std::chrono::seconds(90)});
    EXPECT_EQ(outcome.code, expected_code) << outcome.err;
    return Json::parse(outcome.out, nullptr, false);
  }

  static void expect_explored_with_equal_maps(const Json& run) {
    ASSERT_FALSE(run.is_discarded());
    const Json& result = run["result"];
    EXPECT_EQ(result["status"], "explored");
    EXPECT_EQ(result["explored_fraction"], 1.0);
    EXPECT_TRUE(result["maps_equal"].get<bool>());
    for (const auto& [name, link] : result["link"].items()) {
      ASSERT_TRUE(link.is_object()) << name << " was killed";
      EXPECT_GT(link["sent"].get<int>(), 0) << name;
      EXPECT_LE(link["bytes"].get<double>() / link["sent"].get<double>(), 1200.0);
    }
  }

  /// The latest moment at which a robot heard of a map that was not its own [s].
  static double maps_differed_until(const Json& run) {
    double t = 0.0;
    for (const auto& [name, link] : run["result"]["link"].items())
      if (link.is_object()) t = std::max(t, link["maps_differed_until_s"].get<double>());
    return t;
  }
};

TEST_F(Live, ATeamExploresAndEveryMapIsTheSame) {
  const Json run = team({"--out", "run", "--record", "run.lcm"});
  expect_explored_with_equal_maps(run);
  for (const char* file : {"run.json", "timeline.csv", "events.jsonl", "map.yaml", "report.html", "trajectories/a.tum", "robots/d/map.pgm"})
    EXPECT_TRUE(fs::exists(dir / "run" / file)) << file;
  for (const char* robot : {"b", "c", "d"})
    EXPECT_EQ(slurp(dir / "run/robots" / robot / "map.pgm"), slurp(dir / "run/robots/a/map.pgm"));

  const Outcome replay = this->run({"replay", "run.lcm", "--json", "--out", "again"});
  ASSERT_EQ(replay.code, 0) << replay.err << replay.out;
  EXPECT_TRUE(Json::parse(replay.out)["result"]["maps_as_in_the_run"].get<bool>());
  EXPECT_EQ(slurp(dir / "again/map.pgm"), slurp(dir / "run/map.pgm"));
  EXPECT_EQ(slurp(dir / "again/robots/c/map.pgm"), slurp(dir / "run/robots/c/map.pgm"));
}

TEST_F(Live, WithoutAMulticastRouteATeamMakesANetworkOfItsOwn) {
  const Json run = team({"--private-network", "--robots", "2"}, 2);
  EXPECT_TRUE(run.is_discarded()) << "--team excludes --robots";
  const Outcome outcome = this->run({"team", "rooms.txt", "--robots", "2", "--private-network", "--json", "--speed", "20"},
                                    {.limit = std::chrono::seconds(60)});
  if (outcome.code == 2) GTEST_SKIP() << "no namespace within a namespace: " << outcome.err;
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_TRUE(Json::parse(outcome.out)["result"]["maps_equal"].get<bool>());
}

TEST_F(Live, ABreakOfOneRobotHeals) {
  const Json run = team({"--comms", "break:5-30:b", "--out", "run"});
  expect_explored_with_equal_maps(run);
  RecordProperty("maps_differed_until_ms", static_cast<int>(1000.0 * maps_differed_until(run)));
}

TEST_F(Live, HalvesThatComeTogetherAgainHaveOneMap) {
  const Json run = team({"--comms", "split:3-40:a+b"});
  expect_explored_with_equal_maps(run);
  RecordProperty("maps_differed_until_ms", static_cast<int>(1000.0 * maps_differed_until(run)));
}

TEST_F(Live, LossAndDelayDoNoHarm) { expect_explored_with_equal_maps(team({"--comms", "loss:0.3,delay:0.2"})); }

TEST_F(Live, ARobotThatIsKilledAndStartedAgainCatchesUp) {
  const Json run = team({"--fault", "kill:b@6,revive:b@25"});
  expect_explored_with_equal_maps(run);
}

TEST_F(Live, TheOthersExploreWhatADeadRobotLeaves) {
  const Json run = team({"--fault", "kill:b@6", "--gone-after", "15"});
  ASSERT_FALSE(run.is_discarded());
  EXPECT_EQ(run["result"]["status"], "explored");
  EXPECT_TRUE(run["result"]["maps_equal"].get<bool>());
  EXPECT_EQ(run["result"]["link"]["b"], "killed");
}

TEST_F(Live, AKeyedTeamHearsItsOwnOnly) {
  spill(dir / "key", std::string(32, 'k'));
  expect_explored_with_equal_maps(team({"--key", "key"}));
  spill(dir / "short", "k");
  const Outcome refused = run({"team", "rooms.txt", "--key", "short"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("short"), std::string::npos);
}

TEST_F(Live, AnInterruptedTeamSavesWhatItHas) {
  const Outcome outcome = run({"team", "rooms.txt", "--team", "team.yaml", "--speed", "1", "--out", "run"},
                              {.interrupt = true, .limit = std::chrono::seconds(30)});
  EXPECT_EQ(outcome.code, 130) << outcome.err;
  EXPECT_EQ(result_of(dir / "run")["status"], "interrupted");
}

TEST_F(Live, NobodyOutlivesATeamThatIsKilled) {
  const auto living = [&] {  // processes in our folder that are not ours
    int count = 0;
    for (const auto& entry : fs::directory_iterator("/proc")) {
      std::error_code error;
      const fs::path cwd = fs::read_symlink(entry.path() / "cwd", error);
      count += !error && cwd == dir;
    }
    return count;
  };
  const pid_t child = fork();
  if (child == 0) {
    if (chdir(dir.c_str()) == 0) execl(OUTRIDER_BINARY, "outrider", "team", "rooms.txt", "--team", "team.yaml", "-q", nullptr);
    _exit(127);
  }
  for (int k = 0; k < 200 && living() < 5; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(living(), 5);
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  for (int k = 0; k < 200 && living() > 0; ++k) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  EXPECT_EQ(living(), 0);
}

TEST_F(Live, BadFlagsStopBeforeAnythingStarts) {
  for (const Args& args : {Args{"team", "nowhere"}, {"team", "rooms.txt", "--fault", "slow:a@3:2", "--team", "team.yaml"},
                           {"team", "rooms.txt", "--url", "udpm://10.0.0.1:7667"}, {"robot", "rooms.txt", "--name", "nobody"},
                           {"robot", "--body", "lcm"}, {"team", "rooms.txt", "--coordinator", "dada"}, {"watch", "--url", "x"}}) {
    const Outcome outcome = run(args);
    EXPECT_EQ(outcome.code, 2) << args[1] << outcome.err;
    EXPECT_FALSE(outcome.err.empty());
  }
}

}  // namespace
}  // namespace outrider::test
