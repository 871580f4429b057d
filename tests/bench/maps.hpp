#pragma once
// Maps for the benchmarks: offices of rooms with doors and clutter, the same for the same size.

#include <cstdint>
#include <random>

#include "world/grid.hpp"
#include "world/ray.hpp"

namespace outrider::bench {

/// Rooms of 60 x 60 cells with doors of 14 cells in all walls, and a post of 4 x 4 cells in
/// every 100 x 100; 0.05 m cells.
inline OccupancyGrid office(int size) {
  constexpr int kRoom = 60, kDoorBegin = 22, kDoorEnd = 36;
  OccupancyGrid map(GridGeometry{0.05, {-1.3, 2.7}, size, size}, CellState::kFree);
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const bool border = x == 0 || y == 0 || x + 1 == size || y + 1 == size;
      const auto wall = [&](int across, int along) {
        return across % kRoom == 0 && (along % kRoom < kDoorBegin || along % kRoom >= kDoorEnd);
      };
      if (border || wall(x, y) || wall(y, x)) map[Cell{x, y}] = CellState::kOccupied;
    }
  std::mt19937_64 random(7);
  for (int i = 0; i < size * size / 10000; ++i) {
    const auto draw = [&] { return static_cast<int>(random() % static_cast<std::uint64_t>(size - 4)); };
    const Cell corner{draw(), draw()};
    for (int k = 0; k < 16; ++k) map[Cell{corner.x + k % 4, corner.y + k / 4}] = CellState::kOccupied;
  }
  return map;
}

inline Point random_free_point(const OccupancyGrid& map, std::mt19937_64& random) {
  for (;;) {
    const Cell c = map.geometry().cell_at(random() % map.size());
    if (map[c] == CellState::kFree) return map.geometry().center(c);
  }
}

/// What simulated scans have seen of `truth`, about 60 % of it. A team that went systematically leaves long frontiers
/// (`scattered` false); scans from scattered places leave many short ones: the hard case.
inline OccupancyGrid explored(const OccupancyGrid& truth, bool scattered) {
  constexpr int kBeams = 4096;  // several a cell at the longest range
  constexpr double kRange = 6.0;
  OccupancyGrid map(truth.geometry());
  std::mt19937_64 random(11);
  const std::size_t scans = truth.size() / (scattered ? 8000 : 1000);
  for (std::size_t scan = 0; scan < scans; ++scan) {
    const Point from = random_free_point(truth, random);
    const Cell at = truth.geometry().cell_of(from);
    if (!scattered && at.x + at.y / 4 > truth.width() * 7 / 10) continue;
    for (int i = 0; i < kBeams; ++i) {
      const double angle = 2.0 * kPi * i / kBeams;
      walk_ray(truth.geometry(), from, std::cos(angle), std::sin(angle), kRange, [&](Cell c, double) {
        map[c] = truth[c];
        return truth[c] != CellState::kOccupied;
      });
    }
  }
  return map;
}

}  // namespace outrider::bench
