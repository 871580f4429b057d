// How long a decision of `dvf` takes for one of four robots, on offices of 100, 400 and 1000 cells a side: from scratch,
// and after a robot has seen a little more. Bars on 1000 x 1000 cells: deterministic 30 ms cold, 5 ms warm; stochastic 1 s
// and 0.2 s. Beside each: plain Jacobi value iteration on the same model (one sweep is measured, times the sweeps that
// the longest way needs: stochastic motion needs more) and one pass over the grid's values in memory.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <numeric>

#include "decision/dvf.hpp"
#include "decision/frontiers.hpp"
#include "decision/passability.hpp"
#include "maps.hpp"

namespace outrider {
namespace {

using namespace decision;

/// A partly explored office with what the planner is asked.
struct Problem {
  Grid<std::uint8_t> mask;
  std::vector<Cell> goals;
  Cell at;
  std::vector<Rival> rivals;
};

std::vector<Cell> goals_of(const OccupancyGrid& map, const Grid<std::uint8_t>& mask) {
  constexpr int kBlock = 20;  // cells: one goal a metre
  FrontierExtractor extractor;
  std::vector<Cell> goals;
  Grid<std::uint8_t> taken(GridGeometry{1.0, {}, map.width() / kBlock + 1, map.height() / kBlock + 1});
  for (const std::uint32_t i : extractor.extract(map).cells) {
    const Cell c = map.geometry().cell_at(i);
    std::uint8_t& block = taken[Cell{c.x / kBlock, c.y / kBlock}];
    if (!mask[c] || block != 0) continue;
    block = 1;
    goals.push_back(c);
  }
  return goals;
}

/// Before and after a robot has seen one metre more around one of its goals.
struct Situations {
  explicit Situations(int size) {
    const OccupancyGrid truth = bench::office(size);
    OccupancyGrid map = bench::explored(truth, false);
    before = problem(map);
    const Cell seen = before.goals[before.goals.size() / 2];
    for (int dy = -20; dy <= 20; ++dy)
      for (int dx = -20; dx <= 20; ++dx)
        if (const Cell c{seen.x + dx, seen.y + dy}; dx * dx + dy * dy <= 400 && map.contains(c)) map[c] = truth[c];
    after = problem(map);
  }

  static Problem problem(const OccupancyGrid& map) {
    Problem p;
    p.mask = passable_mask(map, 0.2);
    p.goals = goals_of(map, p.mask);
    std::mt19937_64 random(3);
    const auto place = [&] {
      for (;;)
        if (const Cell c = map.geometry().cell_at(random() % map.size()); p.mask[c]) return c;
    };
    p.at = place();
    for (int k = 0; k < 3; ++k) p.rivals.push_back({.at = place()});
    return p;
  }

  Problem before, after;
};

double milliseconds(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

double jacobi_ms(const Problem& p, const DvfReading& reading) {
  constexpr int kSweeps = 3;
  std::vector<Goal> goals;
  for (const Cell g : p.goals) goals.push_back({g, 1.0});
  const GridMdp model(p.mask, goals, reading.gamma, reading.motion);
  Wavefront front;
  front.compute(p.mask, goals, reading.gamma);
  double longest = 0.0;
  for (std::size_t i = 0; i < p.mask.size(); ++i)
    if (const Cell c = p.mask.geometry().cell_at(i); front.reached(c)) longest = std::max(longest, front.metres(c));
  const double sweeps = longest / p.mask.geometry().resolution / kDiagonalLength;  // steps, were they all diagonal
  const double ms = milliseconds([&] { benchmark::DoNotOptimize(ValueIteration{.most_sweeps = kSweeps}(model)); });
  return ms / kSweeps * std::max(sweeps, 1.0);
}

double memory_ms(std::size_t cells) {
  std::vector<float> values(cells, 1.0F);
  return milliseconds([&] { benchmark::DoNotOptimize(std::accumulate(values.begin(), values.end(), 0.0F)); });
}

void report(benchmark::State& state, std::vector<double> ms, const Problem& p, const DvfReading& reading) {
  std::sort(ms.begin(), ms.end());
  const double median = ms[ms.size() / 2];
  state.counters["p50_ms"] = median;
  state.counters["p95_ms"] = ms[ms.size() * 95 / 100];
  state.counters["max_ms"] = ms.back();
  state.counters["goals"] = static_cast<double>(p.goals.size());
  state.counters["jacobi/x"] = jacobi_ms(p, reading) / median;
  state.counters["x/memory"] = median / memory_ms(p.mask.size());
}

DvfReading reading_of(const benchmark::State& state) {
  DvfReading reading;
  if (state.range(1) != 0) reading.motion.ahead = 0.8;
  return reading;
}

void Decision_Cold(benchmark::State& state) {
  const Situations s(static_cast<int>(state.range(0)));
  const DvfReading reading = reading_of(state);
  std::vector<double> ms;
  for (auto _ : state)
    ms.push_back(milliseconds([&] {
      DvfPlanner planner(reading);
      benchmark::DoNotOptimize(planner.plan(s.before.mask, s.before.at, s.before.goals, s.before.rivals));
    }));
  report(state, ms, s.before, reading);
}

void Decision_Warm(benchmark::State& state) {
  const Situations s(static_cast<int>(state.range(0)));
  const DvfReading reading = reading_of(state);
  DvfPlanner planner(reading);
  planner.plan(s.before.mask, s.before.at, s.before.goals, s.before.rivals);
  std::vector<double> ms;
  bool later = false;
  for (auto _ : state) {
    const Problem& p = (later = !later) ? s.after : s.before;
    ms.push_back(milliseconds([&] { benchmark::DoNotOptimize(planner.plan(p.mask, p.at, p.goals, p.rivals)); }));
  }
  report(state, ms, s.before, reading);
}

/// The empathic values alone, as the prototype measured them.
void Decision_Wavefront(benchmark::State& state) {
  const Situations s(static_cast<int>(state.range(0)));
  std::vector<Goal> goals;
  for (const Cell g : s.before.goals) goals.push_back({g, 1.0});
  Wavefront front;
  std::vector<double> ms;
  for (auto _ : state) ms.push_back(milliseconds([&] { front.compute(s.before.mask, goals, 0.9); }));
  report(state, ms, s.before, {});
}

void sizes(benchmark::internal::Benchmark* b) {
  b->ArgNames({"cells", "stochastic"})->Unit(benchmark::kMillisecond)->MinTime(0.3);
}

BENCHMARK(Decision_Cold)->ArgsProduct({{100, 400, 1000}, {0, 1}})->Apply(sizes);
BENCHMARK(Decision_Warm)->ArgsProduct({{100, 400, 1000}, {0, 1}})->Apply(sizes);
BENCHMARK(Decision_Wavefront)->ArgsProduct({{100, 400, 1000}, {0}})->Apply(sizes);

}  // namespace
}  // namespace outrider
