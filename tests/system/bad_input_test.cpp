// Bad usage and bad input: exit code 2, a message that says where and what was expected, nothing written.

#include <random>

#include "system/run.hpp"

namespace outrider::test {
namespace {

class BadInput : public SystemTest {
 protected:
  /// Every word of `named` is in the message.
  void expect_refused(Args args, const std::vector<std::string>& named, bool with_out = true) const {
    if (with_out) args.insert(args.end(), {"--out", "out"});
    std::string line;
    for (const std::string& arg : args) line += arg + ' ';
    SCOPED_TRACE(line);
    const auto before = tree(dir);
    const Outcome outcome = run(args);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(outcome.err.substr(0, 10), "outrider: ") << outcome.err;
    EXPECT_LT(outcome.err.size(), 400U) << outcome.err;
    for (const std::string& word : named)
      EXPECT_NE(outcome.err.find(word), std::string::npos) << word << " in\n" << outcome.err;
    EXPECT_TRUE(tree(dir) == before) << "files changed";
  }

  void team(const std::string& text) const { spill(dir / "team.yaml", text); }
  void expect_team_refused(const std::string& text, const std::vector<std::string>& named) const {
    team(text);
    expect_refused({"explore", "office1", "--team", "team.yaml"}, named);
  }

  static std::string noise(std::size_t bytes, unsigned seed) {
    std::mt19937_64 random(seed);
    std::string text(bytes, 0);
    for (char& c : text) c = static_cast<char>(random() & 0xff);
    return text;
  }
};

TEST_F(BadInput, FilesThatAreNotThere) {
  expect_refused({"replay", "none.rawlog"}, {"none.rawlog", "no such file"});
  expect_refused({"replay", "."}, {"directory"});
  expect_refused({"explore", "none.yaml"}, {"none.yaml", "office1"});
  expect_refused({"explore", "offise1"}, {"'offise1'", "did you mean 'office1'"});
  expect_refused({"explore", "office1", "--team", "none.yaml"}, {"none.yaml"});
  expect_refused({"explore", "office1", "--team", "."}, {"team file"});
  expect_refused({"map", "none.pgm", "out.yaml"}, {"none.pgm"}, false);
  expect_refused({"report", "none"}, {"none", "expected a run folder"}, false);
}

TEST_F(BadInput, LogsThatAreBroken) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    SCOPED_TRACE(seed);
    spill(dir / "noise.rawlog", noise(5000, seed));
    spill(dir / "noise.log", noise(5000, seed));
    expect_refused({"replay", "noise.rawlog"}, {"noise.rawlog"});
    expect_refused({"replay", "noise.log"}, {"noise.log"});
  }
  spill(dir / "empty.log", "");
  spill(dir / "silent.log", "# only a comment\n");
  spill(dir / "empty.rawlog", "");
  expect_refused({"replay", "empty.log"}, {"empty.log", "expected"});
  expect_refused({"replay", "silent.log"}, {"silent.log"});
  expect_refused({"replay", "empty.rawlog"}, {"empty.rawlog", "expected"});
}

TEST_F(BadInput, RawlogCutOrWithOneByteFlipped) {
  const std::string whole = slurp(packaged_rawlog());
  if (whole.empty()) GTEST_SKIP() << packaged_rawlog() << " is not installed (package mrpt-apps)";
  for (const double part : {0.0001, 0.3, 0.9, 0.9999}) {
    SCOPED_TRACE(part);
    spill(dir / "cut.rawlog", whole.substr(0, static_cast<std::size_t>(part * static_cast<double>(whole.size()))));
    expect_refused({"replay", "cut.rawlog", "--slam", "odometry"}, {"cut.rawlog"});
  }
  std::string flipped = whole;
  flipped[whole.size() / 2] = static_cast<char>(flipped[whole.size() / 2] ^ 0x55);
  spill(dir / "flipped.rawlog", flipped);
  expect_refused({"replay", "flipped.rawlog", "--slam", "odometry"}, {"flipped.rawlog"});
}

TEST_F(BadInput, MapsThatAreNone) {
  spill(dir / "noise.png", noise(3000, 1));
  spill(dir / "text.png", "no image\n");
  spill(dir / "empty.txt", "");
  spill(dir / "empty.yaml", "");
  spill(dir / "noise.gridmap", noise(3000, 2));
  spill(dir / "noise.map", noise(3000, 3));
  expect_refused({"explore", "noise.png", "--resolution", "0.1"}, {"noise.png", "image"});
  expect_refused({"explore", "text.png"}, {"text.png", "--resolution"});
  expect_refused({"explore", "empty.txt"}, {"empty.txt", "empty"});
  expect_refused({"explore", "empty.yaml"}, {"empty.yaml", "image", "origin"});
  expect_refused({"explore", "noise.gridmap"}, {"noise.gridmap"});
  expect_refused({"explore", "noise.map"}, {"noise.map"});
  expect_refused({"map", "office1", "out.foo"}, {"out.foo", "expected .yaml"}, false);
  expect_refused({"map", "office1", "none/out.yaml"}, {"none", "folder"}, false);
  expect_refused({"map", "office1"}, {"OUT"}, false);
}

TEST_F(BadInput, TeamFiles) {
  expect_team_refused("robots:\n  - {name: a, start: [0.1, 0.1, 0]}\n", {"team.yaml", "'a'", "wall"});
  expect_team_refused("robots:\n  - {name: a, start: [-10, 1, 0]}\n", {"team.yaml", "'a'", "off the map"});
  expect_team_refused("robots:\n  - name: a\n    start: [0.875, 7.375, 0]\n    sped: 1\n",
                      {"team.yaml:4:", "'sped'", "did you mean 'speed'"});
  expect_team_refused("robots:\n  - {name: [a}\n", {"team.yaml:2:"});
  expect_team_refused("robots:\n  - {name: [a, b]}\n", {"team.yaml:2:", "name"});
  expect_team_refused("robots:\n  - {[a, b]: c}\n", {"team.yaml:2:", "key"});
  expect_team_refused("robots:\n  - {name: a}\n  - {name: a}\n", {"team.yaml:3:", "'a'"});
  expect_team_refused("robots:\n  - {name: ../a}\n", {"team.yaml:2:", "'../a'"});
  expect_team_refused("robots:\n  - {speed: fast}\n", {"team.yaml:2:", "speed", "m/s"});
  expect_team_refused("robots:\n  - {speed: .nan}\n", {"team.yaml:2:", "speed", "m/s"});
  expect_team_refused("robots: 3\n", {"team.yaml", "expected"});
  expect_team_refused("", {"team.yaml", "expected"});
}

TEST_F(BadInput, NamesAndFlagsSuggestTheNearest) {
  expect_refused({"explore", "office1", "--coordinator", "nearst"}, {"'nearst'", "did you mean 'nearest'"});
  expect_refused({"explore", "office1", "--coordinator", "zzzzzzzz"}, {"known: ", "burgard"});
  expect_refused({"explor", "office1"}, {"unknown verb 'explor'", "did you mean 'explore'"});
  expect_refused({"explore", "office1", "--coordinater", "ia"}, {"'--coordinater'", "did you mean '--coordinator'"});
  expect_refused({"explore", "office1", "-Z"}, {"-Z"});
  expect_refused({"explore", "office1", "office2"}, {"office2"});
  expect_refused({"replay", "x.log", "--slam", "icpp"}, {"--slam", "'icpp'", "did you mean 'icp'"});
  expect_refused({"list", "nothing"}, {"nothing", "coordinators"}, false);
  expect_refused({}, {"--help"}, false);
}

TEST_F(BadInput, StartsOfSeveralLogs) {
  expect_refused({"replay", "x.log", "y.log"}, {"2 logs", "--start", "--unknown-starts"});
  expect_refused({"replay", "x.log", "y.log", "--start", "0,0,0"}, {"2 logs", "--unknown-starts"});
  expect_refused({"replay", "x.log", "--start", "1,2"}, {"--start", "\"x,y,theta\"", "'1,2'"});
  expect_refused({"replay", "x.log", "--start", "1,2,nan"}, {"--start", "'1,2,nan'"});
  expect_refused({"replay", "x.log", "--start", "0,0,0", "--start", "1,0,0"}, {"--start", "1 log"});
}

TEST_F(BadInput, FaultsAndComms) {
  for (const char* spec :
       {"kill", "kill:", "kill:robot1", "kill:robot1@", "kill:robot1@-1", "kill:robot1@nan", "kill:robot1@3:4",
        "kil:robot1@3", "kill:robot9@3", "slow:robot1@3", "slow:robot1@3:x", "kill:robot1@3,,kill:robot2@3",
        "deaf:robot1@3", "deaf:robot1@3-2", "deaf:robot1@3-4-5", "deaf:robot7@3-4"})
    expect_refused({"explore", "office1", "--fault", spec}, {"--fault"});
  for (const char* spec : {"", "idel", "none,ideal", "range:x", "range", "range:-1", "range:nan", "loss:2", "loss:", "delay:1x",
        "breaks:5", "breaks:0x5", "breaks:5x-1", "breaks:5x25@100", "break:5", "break:9-5", "break:5-9:robot77",
        "split:5-9", "ideal,,los", "los:3"})
    expect_refused({"explore", "office1", "--comms", spec}, {"--comms"});
}

TEST_F(BadInput, Numbers) {
  const std::vector<std::pair<const char*, std::vector<const char*>>> cases{
      {"--robots", {"0", "-1", "x", "1001", "1.5"}},
      {"--seed", {"-1", "x", "99999999999999999999"}},
      {"--jobs", {"0", "x"}},
      {"--until", {"0", "1.5", "nan", "x"}},
      {"--max-time", {"0", "-1", "nan", "inf"}},
      {"--range-noise", {"-1", "nan"}},
      {"--bids", {"rho=nan", "rho=inf", "alpha=-1", "rho", "roh=1", "gain=all"}},
      {"--resolution", {"0", "nan", "-0.1"}}};
  for (const auto& [flag, values] : cases)
    for (const char* value : values) expect_refused({"explore", "office1", flag, value}, {flag});
}

TEST_F(BadInput, RunFoldersAreNeverOverwritten) {
  fs::create_directory(dir / "full");
  spill(dir / "full/precious", "work of a year");
  expect_refused({"explore", "office1", "--out", "full"}, {"full", "not empty", "--force"}, false);
  expect_refused({"explore", "office1", "--out", "full/precious"}, {"full/precious", "not a directory"}, false);
  expect_refused({"explore", "office1", "--out", "full/precious/x"}, {"not a directory"}, false);
  expect_refused({"explore", "office1", "--out", ""}, {"--out"}, false);
  expect_refused({"map", "office1", "full/precious"}, {"exists", "--force"}, false);
  expect_refused({"report", "full"}, {"full/run.json"}, false);
}

}  // namespace
}  // namespace outrider::test
