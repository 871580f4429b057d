// What a user of `outrider sweep` relies on: shards and stops do not change a byte, one failure stops nothing else.

#include "system/run.hpp"

namespace outrider::test {
namespace {

class Sweep : public SystemTest {
 protected:
  void SetUp() override {
    SystemTest::SetUp();
    spill(dir / "sweep.yaml",
          "base: {world: labyrinth, robots: 2, starts: random, until: 0.5}\n"
          "axes:\n  coordinator: [nearest, daa]\n  comms: [ideal, \"loss:0.2\"]\nseeds: 2\n");
  }

  /// The files that a sweep leaves, but its journal (which is in the order in which runs ended).
  std::map<std::string, std::string> results(const std::string& folder) const {
    auto files = tree(dir / folder);
    files.erase("journal.jsonl");
    return files;
  }
};

TEST_F(Sweep, ShardsThreadsAndStopsDoNotChangeAByte) {
  ASSERT_EQ(run({"sweep", "sweep.yaml", "-q", "--out", "whole"}).code, 0);
  const auto whole = results("whole");
  EXPECT_EQ(whole.size(), 4U);
  EXPECT_EQ(Json::parse(whole.at("sweep.json"))["rows"].size(), 8U);

  ASSERT_EQ(run({"sweep", "sweep.yaml", "-q", "--shard", "1/2", "--jobs", "2", "--out", "a"}).code, 0);
  ASSERT_EQ(run({"sweep", "sweep.yaml", "-q", "--shard", "2/2", "--out", "b"}).code, 0);
  ASSERT_EQ(run({"sweep", "--merge", "b", "a", "-q", "--out", "merged"}).code, 0);
  EXPECT_EQ(results("merged"), whole);

  // As a kill leaves it: some runs done, the last line cut short.
  const std::string journal = slurp(dir / "whole/journal.jsonl");
  const std::size_t third = journal.find('\n', journal.find('\n') + 1) + 20;
  fs::create_directory(dir / "stopped");
  spill(dir / "stopped/journal.jsonl", journal.substr(0, third));
  const Outcome resumed = run({"sweep", "sweep.yaml", "--out", "stopped"});
  ASSERT_EQ(resumed.code, 0);
  EXPECT_NE(resumed.err.find("2 runs are there"), std::string::npos) << resumed.err;
  EXPECT_EQ(results("stopped"), whole);
}

TEST_F(Sweep, OneFailureStopsNothingElse) {
  spill(dir / "pocket.txt", "######\n#1..2#\n#....#\n######\n");
  spill(dir / "sweep.yaml", "base: {world: pocket.txt}\naxes: {robots: [1, 2], fault: [\"\", \"kill:robot1@0\"]}\n"
                            "compare: fault\n");
  const Outcome outcome = run({"sweep", "sweep.yaml", "--json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Json rows = Json::parse(outcome.out).at("rows");
  ASSERT_EQ(rows.size(), 4U);
  EXPECT_EQ(rows[0]["status"], "explored");
  EXPECT_EQ(rows[1]["status"], "failed");  // nobody lives
  EXPECT_EQ(rows[3]["status"], "explored");
}

TEST_F(Sweep, RefusesNonsenseBeforeTheFirstRun) {
  const std::map<std::string, std::string> files{
      {"axes: {coordinater: [daa]}\n", "did you mean 'coordinator'"},
      {"axes: {coordinator: [daa, dax]}\n", "unknown coordinator 'dax'"},
      {"axes: {coordinator: daa}\n", "expected a list"},
      {"axes: {world: [nowhere]}\n", "nowhere"},
      {"axes: {robots: [0]}\n", "robots"},
      {"axes: {robots: [1, 1]}\n", "twice"},
      {"base: {robots: 2}\naxes: {robots: [1]}\n", "under base already"},
      {"axes: {robots: [1]}\nseeds: -3\n", "sweep.yaml:2"},
      {"axes: {robots: [1]}\ncompare: world\n", "is no axis"},
      {"seeds: 3\n", "expected 'axes"}};
  for (const auto& [text, complaint] : files) {
    spill(dir / "sweep.yaml", text);
    const Outcome outcome = run({"sweep", "sweep.yaml", "--out", "out"});
    EXPECT_EQ(outcome.code, 2) << text;
    EXPECT_NE(outcome.err.find(complaint), std::string::npos) << text << outcome.err;
    EXPECT_FALSE(fs::exists(dir / "out")) << text;
  }
  EXPECT_EQ(run({"sweep"}).code, 2);
  EXPECT_EQ(run({"sweep", "--merge", "nothing"}).code, 2);
}

}  // namespace
}  // namespace outrider::test
