// Bar: 4 robots with lidars of 360 beams at 10 Hz, mapping and planning included, at 200 times real time on one core
// (Stage 4.3 on like work, without mapping: 82 to 91). Beside it the simulator alone, everybody standing still.

#include <benchmark/benchmark.h>

#include "explorer/mission.hpp"
#include "maps.hpp"
#include "sim/simulator.hpp"

namespace outrider {
namespace {

constexpr int kSize = 320;  // 16 x 16 m of 0.05 m cells, as Stage's cave

std::vector<RobotSpec> team() {
  std::vector<RobotSpec> robots(4);
  const GridGeometry g = bench::office(kSize).geometry();
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const Point start = g.center({30 + 14 * static_cast<int>(i), 29});
    robots[i].name = std::string(1, static_cast<char>('a' + i));
    robots[i].start = {start.x, start.y, 0.0};
    robots[i].range = 8.0;
  }
  return robots;
}

/// The office without its clutter, so that everybody finds a place to start.
OccupancyGrid hall() {
  OccupancyGrid map = bench::office(kSize);
  for (int y = 15; y < 45; ++y)
    for (int x = 15; x < 100; ++x) map[Cell{x, y}] = CellState::kFree;
  return map;
}

sim::SimOptions lidar() {
  sim::SimOptions options;
  options.lidar = true;
  options.range_noise = 0.01;
  return options;
}

void SimSpeed_LidarOnly(benchmark::State& state) {
  sim::Simulator simulator(hall(), team(), lidar());
  for (auto _ : state) {
    simulator.step();
    for (RobotId id = 0; id < 4; ++id) benchmark::DoNotOptimize(&simulator.body(id).sense());
  }
  state.counters["x_real_time"] = benchmark::Counter(simulator.now(), benchmark::Counter::kIsRate);
}

void SimSpeed_Mission(benchmark::State& state) {
  explorer::MissionSettings settings;
  settings.sim = lidar();
  settings.record_events = false;
  double simulated = 0.0, explored = 0.0;
  for (auto _ : state) {
    const explorer::MissionResult result = explorer::run_mission(hall(), team(), settings);
    simulated += result.mission_time_s;
    explored = result.explored_fraction;
  }
  state.counters["x_real_time"] = benchmark::Counter(simulated, benchmark::Counter::kIsRate);
  state.counters["explored"] = explored;
}

/// The field of Dai 2014: 100 x 100 m, four unlike robots, daa, to 99 %. Bar: 3 ms a run.
void SimSpeed_Dai(benchmark::State& state) {
  sim::World world = sim::embedded_world("field");
  world.map = explorer::solid_map(std::move(world.map));
  const std::vector<double> radii(4, 0.45), speeds{3.0, 4.0, 3.0, 2.0}, ranges{4.0, 8.0, 3.0, 4.0};
  const auto starts = sim::spread_starts(world, radii);
  std::vector<RobotSpec> robots(4);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    robots[i].name = "R" + std::to_string(i + 1);
    robots[i].start = starts[i];
    robots[i].speed = speeds[i];
    robots[i].range = ranges[i];
    robots[i].radius = radii[i];
  }
  explorer::MissionSettings settings;
  settings.until = 0.99;
  settings.record_events = false;
  for (auto _ : state) benchmark::DoNotOptimize(explorer::run_mission(world.map, robots, settings).time_s);
}

BENCHMARK(SimSpeed_Dai)->Unit(benchmark::kMillisecond);
BENCHMARK(SimSpeed_LidarOnly)->Unit(benchmark::kMicrosecond);
BENCHMARK(SimSpeed_Mission)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace outrider
