// Bars: a round of IA-A, EA-A, DAA-A with 64 robots and 1,000 frontier clusters 10 ms; all tasks to 100 robots 15 ms
// for 1,000; the optimal assignment 10 us for 10 x 100, 1 ms for 100 x 1000. Reference: the auction as the paper words
// it.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "auction/allocation.hpp"
#include "auction/assignment.hpp"
#include "world/ray.hpp"

namespace outrider {
namespace {

const GridGeometry kGround{1.0, {0.0, 0.0}, 400, 400};

std::vector<BidSheet> sheets(int robots, int tasks) {
  std::mt19937_64 random(5);
  const auto cell = [&] { return Cell{static_cast<int>(random() % 400), static_cast<int>(random() % 400)}; };
  std::vector<Cell> cells;
  for (int p = 0; p < tasks; ++p) cells.push_back(cell());
  std::sort(cells.begin(), cells.end(), [](Cell a, Cell b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
  std::vector<BidSheet> result;
  for (int i = 0; i < robots; ++i) {
    const Point at = kGround.center(cell());
    BidSheet sheet{.robot = i, .pose = {at.x, at.y, 0.0}, .speed = 1.0 + i % 3, .range = 8.0 + 4.0 * (i % 4)};
    sheet.explored_rate = i % 5;
    for (const Cell c : cells)
      sheet.entries.push_back(
          {c, c, static_cast<float>(random() % 50), static_cast<float>(distance(at, kGround.center(c)))});
    result.push_back(std::move(sheet));
  }
  return result;
}

/// The whole round as its closer computes it: table and auction, with the lines of sight on a map.
void Auction_Round(benchmark::State& state, auction::BidRule rule) {
  const auto bids = sheets(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const OccupancyGrid map(kGround, CellState::kFree);
  const auto clear = [&](Point a, Point b) { return line_of_sight(map, kGround.cell_of(a), kGround.cell_of(b)); };
  for (auto _ : state) {
    const auction::BidTable table(bids, kGround);
    benchmark::DoNotOptimize(auction::sequential_auction(table, rule, {}, clear));
  }
}

/// Every bid anew at every stage.
void Auction_Plain(benchmark::State& state) {
  const auto bids = sheets(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const auction::BidTable table(bids, kGround);
  const std::size_t n = table.robots(), m = table.tasks();
  for (auto _ : state) {
    std::vector<int> target(n, -1);
    std::vector<char> sold(m, 0);
    for (std::size_t stage = 0; stage < n; ++stage) {
      double best = -std::numeric_limits<double>::infinity();
      std::size_t robot = 0, task = 0;
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t p = 0; p < m && target[i] < 0; ++p) {
          if (sold[p]) continue;
          double u_p2 = 0.0;
          for (std::size_t j = 0; j < n; ++j) {
            if (j == i) continue;
            const Point at =
                target[j] >= 0 ? table.task_point(static_cast<std::size_t>(target[j])) : table.sheet(j).pose.position();
            const double d = distance(table.task_point(p), at), r = table.sheet(j).range;
            u_p2 -= std::exp(-d * d / (r * r));
          }
          const auto* entry = table.entry(i, p);
          const double e = auction::bid_daa({entry->gain, u_p2, entry->distance, table.sheet(i).speed, 1.0}, {});
          if (e > best) best = e, robot = i, task = p;
        }
      target[robot] = static_cast<int>(task);
      sold[task] = 1;
    }
    benchmark::DoNotOptimize(target.data());
  }
}

void Auction_AllTasks(benchmark::State& state) {
  const auto bids = sheets(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)));
  const auction::BidTable table(bids, kGround);
  for (auto _ : state) benchmark::DoNotOptimize(auction::all_tasks_auction(table));
}

void Auction_Optimal(benchmark::State& state) {
  const auto n = static_cast<std::size_t>(state.range(0)), m = static_cast<std::size_t>(state.range(1));
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> place(0.0, 400.0);
  std::vector<Point> from(n), to(m);
  for (Point& p : from) p = {place(random), place(random)};
  for (Point& p : to) p = {place(random), place(random)};
  std::vector<double> cost;
  for (const Point a : from)
    for (const Point b : to) cost.push_back(distance(a, b));
  for (auto _ : state) benchmark::DoNotOptimize(auction::least_cost_assignment(cost, n, m));
}

BENCHMARK_CAPTURE(Auction_Round, ia, auction::bid_ia)->Args({64, 1000})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Auction_Round, ea, auction::bid_ea)->Args({64, 1000})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Auction_Round, daa, auction::bid_daa)->Args({64, 1000})->Unit(benchmark::kMillisecond);
BENCHMARK(Auction_Plain)->Args({16, 250})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(Auction_Round, daa_small, auction::bid_daa)->Args({16, 250})->Unit(benchmark::kMillisecond);
BENCHMARK(Auction_AllTasks)->Args({10, 100})->Args({100, 1000})->Unit(benchmark::kMillisecond);
BENCHMARK(Auction_Optimal)->Args({10, 100})->Args({100, 1000})->Args({1000, 1000})->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace outrider
