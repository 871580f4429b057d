// Bars: 0.5 ms on 1000 x 1000 and 8 ms on 4000 x 4000 cells. Floor: one pass over the bytes. References: a breadth
// first search over the plain definition, and OpenCV's labelling.

#include <benchmark/benchmark.h>

#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "decision/frontiers.hpp"
#include "maps.hpp"

namespace outrider {
namespace {

/// Arguments: cells along an edge; 1 for the hard case of scattered scans.
const OccupancyGrid& explored_office(benchmark::State& state) {
  static std::map<std::pair<std::int64_t, std::int64_t>, OccupancyGrid> maps;
  OccupancyGrid& map = maps[{state.range(0), state.range(1)}];
  if (map.size() == 0) map = bench::explored(bench::office(static_cast<int>(state.range(0))), state.range(1) != 0);
  return map;
}

void Frontiers_Extract(benchmark::State& state) {
  const OccupancyGrid& map = explored_office(state);
  decision::FrontierExtractor extractor;
  for (auto _ : state) benchmark::DoNotOptimize(&extractor.extract(map));
  const auto& found = extractor.extract(map);
  state.counters["cells"] = static_cast<double>(found.cells.size());
  state.counters["clusters"] = static_cast<double>(found.clusters.size());
}

/// What is looked at again after a change: the square of 16 x 16 cells around it.
void Frontiers_OfATile(benchmark::State& state) {
  const OccupancyGrid& map = explored_office(state);
  const Cell low{map.width() / 2, map.height() / 2};
  std::size_t cells = 0;
  for (auto _ : state) decision::for_frontier(map, low, {low.x + 16, low.y + 16}, [&](Cell) { ++cells; });
  benchmark::DoNotOptimize(cells);
}

void Frontiers_FloorOnePass(benchmark::State& state) {
  const OccupancyGrid& map = explored_office(state);
  for (auto _ : state) {
    std::uint8_t all = 0;
    for (const CellState s : map.data()) all = static_cast<std::uint8_t>(all ^ static_cast<std::uint8_t>(s));
    benchmark::DoNotOptimize(all);
  }
}

void Frontiers_PlainSearch(benchmark::State& state) {
  const OccupancyGrid& map = explored_office(state);
  const GridGeometry& g = map.geometry();
  std::size_t cells = 0, clusters = 0;
  for (auto _ : state) {
    cells = clusters = 0;
    std::vector<bool> seen(map.size(), false);
    std::vector<std::size_t> queue;
    for (std::size_t i = 0; i < map.size(); ++i) {
      if (seen[i] || !decision::is_frontier(map, g.cell_at(i))) continue;
      ++clusters;
      seen[i] = true;
      for (queue.assign(1, i); !queue.empty(); ++cells) {
        const Cell c = g.cell_at(queue.back());
        queue.pop_back();
        for (int k = 0; k < 9; ++k) {
          const Cell n{c.x + k % 3 - 1, c.y + k / 3 - 1};
          if (!g.contains(n) || seen[g.index(n)] || !decision::is_frontier(map, n)) continue;
          seen[g.index(n)] = true;
          queue.push_back(g.index(n));
        }
      }
    }
  }
  state.counters["cells"] = static_cast<double>(cells);
  state.counters["clusters"] = static_cast<double>(clusters);
}

void Frontiers_OpenCv(benchmark::State& state) {
  const OccupancyGrid& map = explored_office(state);
  cv::setNumThreads(1);
  const cv::Mat cells(map.height(), map.width(), CV_8U, const_cast<CellState*>(map.data().data()));
  cv::Mat unknown, free, labels, stats, centroids;
  int clusters = 0;
  for (auto _ : state) {
    cv::compare(cells, 0, unknown, cv::CMP_EQ);
    cv::compare(cells, 1, free, cv::CMP_EQ);
    cv::dilate(unknown, unknown, cv::getStructuringElement(cv::MORPH_RECT, {3, 3}));
    cv::bitwise_and(unknown, free, free);
    clusters = cv::connectedComponentsWithStats(free, labels, stats, centroids, 8) - 1;
  }
  state.counters["clusters"] = clusters;
}

BENCHMARK(Frontiers_FloorOnePass)->Args({1000, 0})->Args({4000, 0})->Unit(benchmark::kMillisecond);
BENCHMARK(Frontiers_Extract)
    ->Args({1000, 0})
    ->Args({4000, 0})
    ->Args({1000, 1})
    ->Args({4000, 1})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(Frontiers_OfATile)->Args({1000, 0})->Args({4000, 0})->Unit(benchmark::kMicrosecond);
BENCHMARK(Frontiers_OpenCv)->Args({1000, 0})->Args({4000, 0})->Args({1000, 1})->Unit(benchmark::kMillisecond);
BENCHMARK(Frontiers_PlainSearch)->Args({1000, 0})->Args({1000, 1})->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace outrider
