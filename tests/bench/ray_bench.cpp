// Bar: an exact scan of 360 beams in 100 us on cells of 0.05 m, at a mean range of 79 cells. Floor: the 360 sines and
// cosines. Reference: the plain cell-by-cell walk.

#include <benchmark/benchmark.h>

#include "maps.hpp"

namespace outrider {
namespace {

constexpr int kBeams = 360;
constexpr double kStep = 2.0 * kPi / kBeams, kRange = 20.0;

/// The 1000 x 1000 office, less cluttered to see farther, and 200 places in it.
struct Scene {
  OccupancyGrid map{GridGeometry{0.05, {-1.3, 2.7}, 1000, 1000}, CellState::kFree};
  std::vector<Point> places;
  Scene() {
    for (int y = 0; y < 1000; ++y)
      for (int x = 0; x < 1000; ++x) {
        const auto wall = [](int across, int along) { return across % 160 == 0 && along % 160 > 15; };
        if (wall(x, y) || wall(y, x) || x == 999 || y == 999) map[Cell{x, y}] = CellState::kOccupied;
      }
    std::mt19937_64 random(3);
    for (int i = 0; i < 150; ++i) {
      const Cell corner{static_cast<int>(random() % 995), static_cast<int>(random() % 995)};
      for (int k = 0; k < 25; ++k) map[Cell{corner.x + k % 5, corner.y + k / 5}] = CellState::kOccupied;
    }
    for (int i = 0; i < 200; ++i) {
      const Point p = bench::random_free_point(map, random);
      places.push_back({p.x + 0.011, p.y - 0.017});
    }
  }
};
const Scene& scene() {
  static const Scene s;
  return s;
}

void Scan_Cast(benchmark::State& state) {
  std::vector<float> ranges(kBeams);
  std::size_t i = 0;
  double cells = 0.0, beams = 0.0;
  for (auto _ : state) cast_scan(scene().map, scene().places[i++ % 200], -kPi, kStep, ranges, kRange);
  for (const Point p : scene().places) {
    cast_scan(scene().map, p, -kPi, kStep, ranges, kRange);
    for (const float r : ranges) cells += static_cast<double>(r) / 0.05, ++beams;
  }
  state.counters["mean_range_cells"] = cells / beams;
}

void Scan_PlainWalk(benchmark::State& state) {
  std::vector<float> ranges(kBeams);
  std::size_t place = 0;
  for (auto _ : state) {
    const Point from = scene().places[place++ % 200];
    for (int i = 0; i < kBeams; ++i) {
      const double angle = -kPi + i * kStep;
      double hit = kRange;
      walk_ray(scene().map.geometry(), from, std::cos(angle), std::sin(angle), kRange, [&](Cell c, double t) {
        if (scene().map[c] != CellState::kOccupied) return true;
        hit = t;
        return false;
      });
      ranges[static_cast<std::size_t>(i)] = static_cast<float>(hit);
    }
    benchmark::DoNotOptimize(ranges.data());
  }
}

void Scan_FloorSinesOnly(benchmark::State& state) {
  for (auto _ : state)
    for (int i = 0; i < kBeams; ++i) {
      double angle = -kPi + i * kStep;
      benchmark::DoNotOptimize(angle);
      double sum = std::sin(angle) + std::cos(angle);
      benchmark::DoNotOptimize(sum);
    }
}

BENCHMARK(Scan_FloorSinesOnly)->Unit(benchmark::kMicrosecond);
BENCHMARK(Scan_Cast)->Unit(benchmark::kMicrosecond);
BENCHMARK(Scan_PlainWalk)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace outrider
