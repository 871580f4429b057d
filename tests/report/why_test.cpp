#include "report/why.hpp"

#include <gtest/gtest.h>

namespace outrider::report {
namespace {

/// Two robots, one round: R1 wins (1, 2), R2 goes to (3, 4); R1 arrives at 9 s.
std::vector<Json> events() {
  std::vector<Json> list;
  for (
      const char* line : {
          R"({"t": 2.0, "event": "auction", "opener": "R2", "round": 1, "bids": [
               {"robot": "R1", "busy": false, "explored_rate_m2_s": 4.5, "tasks": [[3, 4, 9, 1], [1, 2, 30, 5]]},
               {"robot": "R2", "busy": false, "explored_rate_m2_s": 1, "tasks": [[3, 4, 9, 2], [1, 2, 30, 9]]}],
               "awards": [{"robot": "R1", "task": [1, 2], "value": 6.5}, {"robot": "R2", "task": [3, 4], "value": 2}], "unheard": []})",
          R"({"t": 2.0, "event": "goal", "robot": "R1", "task": [1, 2], "stand": [1, 2], "distance_m": 5, "value": 6.5})",
          R"({"t": 2.0, "event": "goal", "robot": "R2", "task": [3, 4], "stand": [3, 4], "distance_m": 2, "value": 2})",
          R"({"t": 9.0, "event": "task_end", "robot": "R1", "task": [1, 2], "how": "reached"})"})
    list.push_back(Json::parse(line));
  return list;
}

TEST(Why, NamesTheRoundAndAllBidsForTheTask) {
  const Json answer = why(events(), "R1", 5.0);
  EXPECT_EQ(answer["goal"]["task"], Json::parse("[1, 2]"));
  EXPECT_EQ(answer["auction"]["opener"], "R2");
  EXPECT_EQ(answer["value"], 6.5);
  ASSERT_EQ(answer["for_task"].size(), 2U);
  EXPECT_EQ(answer["for_task"][1]["robot"], "R2");
  EXPECT_EQ(answer["for_task"][1]["distance_m"], 9);
  EXPECT_EQ(answer["for_task"][1]["went_to"], Json::parse("[3, 4]"));
  ASSERT_EQ(answer["own_bids"].size(), 2U);
  EXPECT_EQ(answer["own_bids"][0]["task"], Json::parse("[1, 2]"));  // 30 m2 in 5 m before 9 m2 in 1 m
  EXPECT_EQ(answer["own_bids"][1]["won_by"], "R2");
  const std::string text = why_text(answer);
  for (const char* part :
       {"R1 at 5.0 s: heading for (1.0, 2.0) since 2.0 s", "round 1 of R2", "6.500", "4.50 m²/s", "R2"})
    EXPECT_NE(text.find(part), std::string::npos) << part << "\n" << text;
}

TEST(Why, BeforeAndAfterThereIsNoTask) {
  for (const double t : {1.0, 9.0, 99.0}) {
    const Json answer = why(events(), "R1", t);
    EXPECT_TRUE(answer["goal"].is_null()) << t;
    EXPECT_NE(why_text(answer).find("no task"), std::string::npos);
  }
}

TEST(Why, WithoutAuctionTheGoalStandsAlone) {
  std::vector<Json> list = events();
  list.erase(list.begin());
  const Json answer = why(list, "R2", 5.0);
  EXPECT_TRUE(answer["auction"].is_null());
  EXPECT_NE(why_text(answer).find("No auction"), std::string::npos);
}

}  // namespace
}  // namespace outrider::report
