#pragma once
// Small random maps for comparing fast code with oracles. Print the seed: SCOPED_TRACE(seed).

#include <algorithm>
#include <cstdint>
#include <random>

#include "world/grid.hpp"

namespace outrider::test {

/// A map of up to `largest` x `largest` cells, from empty to dense, of rectangles and single cells in all three
/// states. The same seed gives the same map.
inline OccupancyGrid random_map(std::uint64_t seed, int largest = 40, double resolution = 1.0) {
  std::mt19937_64 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<std::uint64_t>(n)); };
  const int width = 1 + below(largest), height = 1 + below(largest);
  OccupancyGrid map(GridGeometry{resolution, {-3.5, 2.25}, width, height}, static_cast<CellState>(below(3)));
  const int rectangles = below(12), noise_percent = below(3) == 0 ? below(60) : below(8);
  for (int i = 0; i < rectangles; ++i) {
    const auto state = static_cast<CellState>(below(3));
    const int x0 = below(width), y0 = below(height);
    const int x1 = std::min(width, x0 + 1 + below(width)), y1 = std::min(height, y0 + 1 + below(height));
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) map[Cell{x, y}] = state;
  }
  for (std::size_t i = 0; i < map.size(); ++i)
    if (below(100) < noise_percent) map[i] = static_cast<CellState>(below(3));
  return map;
}

/// 1 where `map` is free: where a robot without extent may be.
inline Grid<std::uint8_t> free_cells(const OccupancyGrid& map) {
  Grid<std::uint8_t> mask(map.geometry());
  for (std::size_t i = 0; i < map.size(); ++i) mask[i] = map[i] == CellState::kFree;
  return mask;
}

}  // namespace outrider::test
