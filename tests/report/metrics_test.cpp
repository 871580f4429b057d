#include "report/metrics.hpp"

#include <gtest/gtest.h>

#include "records.hpp"

namespace outrider::report {
namespace {

TEST(Metrics, PathLength) {
  EXPECT_DOUBLE_EQ(path_length(drive({})), 0.0);
  EXPECT_DOUBLE_EQ(path_length(drive({{1, 1}})), 0.0);
  EXPECT_DOUBLE_EQ(path_length(drive({{0, 0}, {3, 4}, {3, 4}, {3, 0}})), 9.0);
}

TEST(Metrics, SeenAreasByHand) {
  std::vector<RobotRecord> team(3);
  team[0].seen = ascii_seen({"1110", "0000"});
  team[1].seen = ascii_seen({"0110", "0001"});
  team[2].seen = ascii_seen({"0010", "0000"});
  const auto areas = seen_areas(team);
  ASSERT_TRUE(areas);
  EXPECT_DOUBLE_EQ(areas->once, 2.0);
  EXPECT_DOUBLE_EQ(areas->twice, 1.0);
  EXPECT_DOUBLE_EQ(areas->more, 1.0);
  EXPECT_DOUBLE_EQ(areas->sum, 7.0);
  EXPECT_DOUBLE_EQ(areas->overlap_fraction(), 0.5);
}

TEST(Metrics, OverlapIsAbsentWithoutSeenGridsOfOneGeometry) {
  std::vector<RobotRecord> team(2);
  EXPECT_FALSE(seen_areas(team));
  EXPECT_FALSE(seen_areas({}));
  team[0].seen = ascii_seen({"11"});
  team[1].seen = ascii_seen({"111"});
  EXPECT_FALSE(seen_areas(team));
  team[1].seen = ascii_seen({"00"});
  team[0].seen = ascii_seen({"00"});
  EXPECT_DOUBLE_EQ(seen_areas(team)->overlap_fraction(), 0.0);
}

TEST(Metrics, TimeToIsTheFirstRowThatReachesTheFraction) {
  const std::vector<TimelineRow> rows{{0.0, 0.1, 1, {}}, {2.0, 0.5, 5, {}}, {3.0, 0.96, 9, {}}};
  EXPECT_EQ(time_to(rows, 0.5), 2.0);
  EXPECT_EQ(time_to(rows, 0.51), 3.0);
  EXPECT_EQ(time_to(rows, 0.99), std::nullopt);
}

TEST(Metrics, PairsShareWhatBothSaw) {
  std::vector<RobotRecord> team(3);
  team[0].seen = ascii_seen({"1110"});
  team[1].seen = ascii_seen({"0110"});
  team[2].seen = ascii_seen({"0000"});
  const auto pairs = *pair_overlaps(team);
  ASSERT_EQ(pairs.size(), 3u);
  EXPECT_DOUBLE_EQ(pairs[0].m2, 2.0);
  EXPECT_DOUBLE_EQ(pairs[0].share_of_smaller, 1.0);
  EXPECT_DOUBLE_EQ(pairs[1].m2, 0.0);
  EXPECT_DOUBLE_EQ(pairs[1].share_of_smaller, 0.0) << "a robot that saw nothing";
}

TEST(Metrics, DistanceWithoutNewsIsWasted) {
  RunRecord record;
  record.robots.resize(1);
  record.robots[0].clock_s = 100.0;  // the log's clock; the timeline counts from its first scan
  record.robots[0].trajectory = {{100.0, {0, 0, 0}}, {101.0, {1, 0, 0}}, {102.0, {3, 0, 0}}, {103.0, {3, 4, 0}}};
  record.timeline = {{0.0, 0, 0, {1.0}}, {1.0, 0, 0, {2.0}}, {2.0, 0, 0, {2.0}}, {3.0, 0, 0, {2.5}}};
  EXPECT_EQ(wasted_m(record), std::vector<double>{2.0});
  record.timeline[1].robot_m2.clear();
  EXPECT_TRUE(wasted_m(record).empty());
}

TEST(Metrics, DerivedResultOfTheSmallRecord) {
  const Json r = derive_result(small_record());
  EXPECT_EQ(r.begin().key(), "status");
  EXPECT_EQ(r["explored_fraction"], 0.75);
  EXPECT_EQ(r["time_s"], 1.0);
  EXPECT_EQ(r["time_to"], Json::parse(R"({"0.5": 1.0, "0.9": null, "0.95": null, "0.99": null})"));
  EXPECT_EQ(r["path_m"], Json::parse(R"({"alice": 3.0, "bob": 1.25})"));
  EXPECT_DOUBLE_EQ(r["share"]["alice"].get<double>(), 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(r["workload_std"].get<double>(), 1.0 / 6.0);
  EXPECT_EQ(r["trajectory_intersections"], 1);
  EXPECT_EQ(r["intersections"], Json::parse(R"({"alice": 1, "bob": 1})"));
  EXPECT_DOUBLE_EQ(r["overlap"]["fraction"].get<double>(), 2.0 / 6.0);
  EXPECT_DOUBLE_EQ(r["overlap"]["sum_cov_minus_cov_team"].get<double>(), 2.0 / 8.0);
  EXPECT_TRUE(r["map_quality"].contains("iou_occupied"));
}

TEST(Metrics, WhatTheRunItselfReportsWins) {
  RunRecord record = small_record();
  record.result["time_s"] = 99.0;
  record.result["scans"] = 5;
  record.result["new_figure"] = 1;
  const Json r = derive_result(record);
  EXPECT_EQ(r["time_s"], 99.0);
  EXPECT_EQ(r["scans"], 5);
  EXPECT_EQ(r["new_figure"], 1);
}

TEST(Metrics, AnEmptyRecordHasAnEmptyResult) { EXPECT_EQ(derive_result({}), Json::object()); }

}  // namespace
}  // namespace outrider::report
