// Figures of map quality against numbers worked out by hand, and laws.

#include "report/map_quality.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "report/records.hpp"

namespace outrider::report {
namespace {

TEST(MapQuality, ByHand) {
  //                                   missed wall v      v unseen free
  const OccupancyGrid truth = ascii_map({"#####", "##..#", "#...#", "#####"});
  const OccupancyGrid map = ascii_map({"?#.##", "?#.?#", "?#..#", "?####"});
  // The column x = 0 holds judged walls too (their neighbours at x = 1 are free in row 1).
  const Grid<MapError> errors = map_errors(map, truth);
  EXPECT_EQ(errors[Cell({2, 3})], MapError::kMissedWall);
  EXPECT_EQ(errors[Cell({3, 2})], MapError::kUnseen);
  EXPECT_EQ(errors[Cell({1, 1})], MapError::kFalseWall);
  EXPECT_EQ(errors[Cell({0, 3})], MapError::kNone) << "inside a wall: nobody can see it";
  EXPECT_EQ(errors[Cell({0, 0})], MapError::kUnseen);
  const MapQuality q = map_quality(map, truth);
  // Judged: 5 free; walls: all but (0,3) = 14. Right walls: 14 - (0,2),(0,1),(0,0) unseen - (2,3) missed = 10.
  EXPECT_DOUBLE_EQ(q.iou_occupied, 10.0 / 15.0);
  EXPECT_DOUBLE_EQ(q.iou_free, 3.0 / 6.0);
  EXPECT_DOUBLE_EQ(q.precision, 10.0 / 11.0);
  EXPECT_DOUBLE_EQ(q.recall, 10.0 / 14.0);
  EXPECT_DOUBLE_EQ(q.accuracy, 13.0 / 15.0);
  EXPECT_DOUBLE_EQ(q.completeness, 15.0 / 19.0);
  EXPECT_DOUBLE_EQ(q.tolerance_m, 1.0) << "no finer than a cell";
  EXPECT_DOUBLE_EQ(q.precision_within, 1.0) << "the false wall touches a true one";
  EXPECT_DOUBLE_EQ(q.wall_to_truth.mean, 1.0 / static_cast<double>(q.wall_to_truth.count));
}

TEST(MapQuality, WhatTheMapDoesNotCoverCountsAsUnknown) {
  const OccupancyGrid truth({0.5, {-1.0, -1.0}, 8, 8}, CellState::kFree);
  OccupancyGrid map({1.0, {0.0, 0.0}, 2, 2}, CellState::kFree);
  map[3] = CellState::kOccupied;
  const MapQuality q = map_quality(map, truth);
  EXPECT_DOUBLE_EQ(q.iou_free, 12.0 / 64.0);
  EXPECT_DOUBLE_EQ(q.completeness, 16.0 / 64.0);
  EXPECT_DOUBLE_EQ(q.accuracy, 0.75);
}

TEST(MapQuality, AFinerMapKeepsItsThinWalls) {
  OccupancyGrid map({0.25, {0.0, 0.0}, 8, 4}, CellState::kFree);
  map[Cell{3, 0}] = CellState::kOccupied;
  const OccupancyGrid coarse = resampled(map, {1.0, {0.0, 0.0}, 3, 1}, {});
  EXPECT_EQ(coarse[0], CellState::kOccupied);
  EXPECT_EQ(coarse[1], CellState::kFree);
  EXPECT_EQ(coarse[2], CellState::kUnknown);
}

/// Distances, precision and recall by looking at every pair of cells.
TEST(MapQuality, DistancesEqualTheSlowOracle) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 20; ++trial) {
    const GridGeometry g{0.1, {1.0, -2.0}, 17, 13};
    OccupancyGrid truth(g), map(g);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      truth[i] = random() % 6 == 0 ? CellState::kOccupied : CellState::kFree;
      map[i] = random() % 3 == 0 ? static_cast<CellState>(random() % 3) : truth[i];
    }
    const MapQuality q = map_quality(map, truth, {}, 0.15);
    double sum = 0.0, near = 0.0, walls = 0.0;
    for (std::size_t i = 0; i < map.size(); ++i) {
      if (map[i] != CellState::kOccupied) continue;
      double nearest = 1e9;
      for (std::size_t k = 0; k < truth.size(); ++k)
        if (truth[k] == CellState::kOccupied)
          nearest = std::min(nearest, distance(g.center(g.cell_at(i)), g.center(g.cell_at(k))));
      sum += nearest;
      near += nearest <= 0.15 ? 1.0 : 0.0;
      walls += 1.0;
    }
    EXPECT_NEAR(q.wall_to_truth.mean, sum / walls, 1e-5) << "trial " << trial;
    EXPECT_NEAR(q.precision_within, near / walls, 1e-9) << "trial " << trial;
  }
}

TEST(MapQuality, ATurnedMapIsMeasuredInTheTruthsFrame) {
  OccupancyGrid truth({0.1, {0.0, 0.0}, 60, 40}, CellState::kFree);
  for (int x = 0; x < 60; ++x) truth[Cell{x, 20}] = CellState::kOccupied;
  for (int y = 0; y < 40; ++y) truth[Cell{13, y}] = CellState::kOccupied;
  const Pose2 T_truth_map{3.0, 2.0, 0.5};
  const OccupancyGrid map = resampled(truth, {0.05, {-6.0, -6.0}, 240, 240}, inverse(T_truth_map));
  const MapQuality q = map_quality(map, truth, T_truth_map);
  EXPECT_GT(q.completeness, 0.99);
  EXPECT_GT(q.precision_within, 0.99);
  EXPECT_GT(q.recall_within, 0.99);
  EXPECT_LT(q.wall_to_truth.mean, 0.05);
  EXPECT_LT(map_quality(map, truth).precision_within, 0.5) << "without the transform it is wrong";
}

}  // namespace
}  // namespace outrider::report
