// Benches beside references, and the question why.

#include <algorithm>
#include <fstream>

#include "system/run.hpp"

namespace outrider::test {
namespace {

class ReferenceBench : public SystemTest {
 protected:
  /// A folder as `bench explore-bench` reads it: one empty hall of 30 x 20 cells.
  void write_folder(const std::string& starts) const {
    fs::create_directory(dir / "maps");
    std::ofstream image(dir / "maps/hall.pgm", std::ios::binary);
    image << "P5\n30 20\n255\n";
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 30; ++x) image.put(x == 0 || y == 0 || x == 29 || y == 19 ? '\0' : static_cast<char>(254));
    std::ofstream(dir / "maps/hall.yaml") << "image: hall.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\n"
                                             "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
    std::ofstream(dir / "maps/starts.yaml") << starts;
  }
};

TEST_F(ReferenceBench, ExploreBenchFinishesBesideItsReferences) {
  write_folder(
      "hall: {single: [[10, 5]], close: [[10, 5], [10, 9]]}\n"
      "reference_t99: {hall: {single: [40, never], close: [20, 25]}}\n");
  const Outcome outcome =
      run({"bench", "explore-bench", (dir / "maps").string(), "--algorithms", "nearest", "--json", "-q"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(document.is_object());
  ASSERT_EQ(document["rows"].size(), 6U);  // two settings, two references and ours
  for (const Json& row : document["rows"]) {
    if (row["algorithm"] == "nearest") {
      EXPECT_TRUE(row["steps"].is_number()) << row.dump();
      EXPECT_LE(row["steps"], row["clock"]);
      if (!row["ratio_bound"].is_null()) {
        EXPECT_GE(row["ratio_bound"], 1.0);
      }
    } else if (row["case"] == "hall-single" && row["algorithm"] == "reference-potential") {
      EXPECT_TRUE(row["steps"].is_null());
    }
  }
}

TEST_F(ReferenceBench, ExploreBenchNamesWhatIsWrongInItsFolder) {
  for (const char* starts :
       {"hall: {single: [[0, 0]]}", "hall: {single: [[10]]}", "hall: [1]", "nowhere: {single: [[1, 1]]}", "- 1"}) {
    fs::remove_all(dir / "maps");
    write_folder(starts);
    const Outcome outcome = run({"bench", "explore-bench", (dir / "maps").string(), "-q"});
    EXPECT_EQ(outcome.code, 2) << starts;
    EXPECT_TRUE(outcome.out.empty());
  }
}

TEST_F(ReferenceBench, TheOracleIsBetweenTheBoundAndTheCoordinators) {
  const Outcome outcome = run({"bench", "oracle", "--worlds", "office1", "--robots", "2", "--trials", "2",
                               "--algorithms", "nearest", "--evaluations", "300", "--json", "-q"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Json document = Json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(document.is_object());
  for (const Json& row : document["rows"]) {
    ASSERT_TRUE(row["time_s"].is_number()) << row.dump();
    if (!row["ratio_bound"].is_null()) {
      EXPECT_GE(row["ratio_bound"], 1.0) << row.dump();
    }
  }
}

TEST_F(ReferenceBench, WhyNamesTheAuctionBehindAGoal) {
  const std::string folder = (dir / "run").string();
  ASSERT_EQ(run({"explore", "office1", "--out", folder, "-q"}).code, 0);
  const Json run_json = Json::parse(std::ifstream(dir / "run/run.json"), nullptr, false);
  const std::string robot = run_json["team"][0]["name"];
  EXPECT_GT(run_json["result"]["competitive_ratio"], 1.0);
  EXPECT_GE(run_json["result"]["auctions"]["gap"], 0.0);
  const Outcome words = run({"report", folder, "--why", robot + "@3"});
  EXPECT_EQ(words.code, 0) << words.err;
  EXPECT_NE(words.out.find("It won this task"), std::string::npos) << words.out;
  const Outcome json = run({"report", folder, "--why", robot + "@3", "--json"});
  EXPECT_TRUE(Json::parse(json.out, nullptr, false)["own_bids"].is_array());
  for (const char* question : {"nobody@3", "3", "x@", "@3"})
    EXPECT_EQ(run({"report", folder, "--why", question}).code, 2) << question;
}

}  // namespace
}  // namespace outrider::test
