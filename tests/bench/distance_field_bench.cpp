// Bars on 1000 x 1000 cells: octile 15 ms, 4-connected 5 ms. Floor: copying a field of 16 bits. Reference: Dijkstra
// with a priority queue over the same steps.

#include <benchmark/benchmark.h>

#include <functional>
#include <queue>

#include "decision/distance_field.hpp"
#include "decision/passability.hpp"
#include "decision/reach_field.hpp"
#include "maps.hpp"

namespace outrider {
namespace {

using decision::DistanceField;
using decision::Steps;

constexpr int kSize = 1000;
const Cell kSource{490, 490};

const Grid<std::uint8_t>& office_mask() {
  static const Grid<std::uint8_t> mask = [] {
    Grid<std::uint8_t> m = decision::passable_mask(bench::office(kSize), 0.0);
    m[kSource] = 1;
    return m;
  }();
  return mask;
}

void compute(benchmark::State& state, double max_m, Steps steps) {
  const auto& mask = office_mask();
  DistanceField field;
  for (auto _ : state) field.compute(mask, {&kSource, 1}, max_m, steps);
  std::size_t reached = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) reached += field.reached(mask.geometry().cell_at(i));
  state.counters["reached"] = static_cast<double>(reached);
}
void DistanceField_Octile(benchmark::State& state) { compute(state, DistanceField::kNoLimit, Steps::kOctile); }
void DistanceField_Octile5m(benchmark::State& state) { compute(state, 5.0, Steps::kOctile); }
void DistanceField_Orthogonal(benchmark::State& state) { compute(state, DistanceField::kNoLimit, Steps::kOrthogonal); }

/// The same 5 m as Octile5m, without a pass over the map.
void ReachField_5m(benchmark::State& state) {
  const auto& mask = office_mask();
  std::vector<std::uint32_t> all(mask.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
  decision::ReachField field(mask.geometry());
  field.update(mask, all);
  for (auto _ : state) {
    field.begin(kSource);
    field.extend(5.0);
  }
}

void DistanceField_FloorCopy(benchmark::State& state) {
  const std::vector<std::uint16_t> from(kSize * kSize, 1);
  std::vector<std::uint16_t> to(from.size());
  for (auto _ : state) {
    std::copy(from.begin(), from.end(), to.begin());
    benchmark::DoNotOptimize(to.data());
    benchmark::ClobberMemory();
  }
}

void DistanceField_PriorityQueue(benchmark::State& state) {
  const auto& mask = office_mask();
  const GridGeometry& g = mask.geometry();
  using Entry = std::pair<std::uint32_t, std::uint32_t>;
  for (auto _ : state) {
    std::vector<std::uint32_t> d(mask.size(), ~0U);
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    d[g.index(kSource)] = 0;
    queue.emplace(0U, static_cast<std::uint32_t>(g.index(kSource)));
    while (!queue.empty()) {
      const auto [at, index] = queue.top();
      queue.pop();
      if (d[index] != at) continue;
      const Cell c = g.cell_at(index);
      for (int k = 0; k < 9; ++k) {
        const Cell n{c.x + k % 3 - 1, c.y + k / 3 - 1};
        if (n == c || !decision::step_allowed(mask, c, n)) continue;
        const std::uint32_t next = at + (n.x != c.x && n.y != c.y ? 7U : 5U);
        if (next >= d[g.index(n)]) continue;
        d[g.index(n)] = next;
        queue.emplace(next, static_cast<std::uint32_t>(g.index(n)));
      }
    }
    benchmark::DoNotOptimize(d.data());
  }
}

BENCHMARK(DistanceField_FloorCopy)->Unit(benchmark::kMillisecond);
BENCHMARK(DistanceField_Octile)->Unit(benchmark::kMillisecond);
BENCHMARK(DistanceField_Octile5m)->Unit(benchmark::kMillisecond);
BENCHMARK(ReachField_5m)->Unit(benchmark::kMillisecond);
BENCHMARK(DistanceField_Orthogonal)->Unit(benchmark::kMillisecond);
BENCHMARK(DistanceField_PriorityQueue)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace outrider
