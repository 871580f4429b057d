// One 360-beam scan into the map: Outrider's exact traversal beside a plain Bresenham that touches every cell of
// every beam (and so updates cells near the robot many times a scan).

#include <benchmark/benchmark.h>

#include "slam_glue/grid_mapper.hpp"
#include "world/body.hpp"
#include "world/ray.hpp"

namespace {

using namespace outrider;

constexpr int kSide = 400;

/// A walled hall of kSide x kSide cells with pillars, so that beams are about 60 cells long on average.
OccupancyGrid pillar_hall() {
  OccupancyGrid map({0.1, {0, 0}, kSide, kSide}, CellState::kFree);
  for (int i = 0; i < kSide; ++i)
    for (const Cell c : {Cell{i, 0}, Cell{i, kSide - 1}, Cell{0, i}, Cell{kSide - 1, i}}) map[c] = CellState::kOccupied;
  for (int y = 20; y < kSide; y += 40)
    for (int x = 20; x < kSide; x += 40)
      for (int k = 0; k < 18; ++k) {
        map[Cell{x, y + k}] = CellState::kOccupied;
        map[Cell{x + k, y}] = CellState::kOccupied;
      }
  return map;
}

std::vector<PosedScan> drive(const OccupancyGrid& map) {
  std::vector<PosedScan> scans;
  for (int i = 0; i < 32; ++i) {
    PosedScan s;
    s.T_map_robot = {10.13 + 0.5 * i, 12.37 + 0.31 * i, 0.1 * i};
    s.scan.angle_min = -kPi;
    s.scan.angle_increment = 2 * kPi / 360;
    s.scan.range_max = 12.0;
    for (std::size_t b = 0; b < 360; ++b) {
      const auto hit = cast_ray(map, s.T_map_robot.position(), s.T_map_robot.theta + s.scan.angle(b), 12.0);
      s.scan.ranges.push_back(static_cast<float>(hit.value_or(12.0)));
    }
    scans.push_back(s);
  }
  return scans;
}

void report_cells(benchmark::State& state, const std::vector<PosedScan>& scans) {
  double sum = 0;
  for (const auto& s : scans)
    for (const float r : s.scan.ranges) sum += r / 0.1F;
  state.counters["cells_a_beam"] = sum / (360.0 * static_cast<double>(scans.size()));
}

void BM_GridMapperInsert(benchmark::State& state) {
  const OccupancyGrid map = pillar_hall();
  const auto scans = drive(map);
  slam_glue::GridMapper mapper(map.geometry());
  std::vector<std::uint32_t> changed;
  std::size_t i = 0;
  for (auto _ : state) {
    changed.clear();
    const auto& s = scans[i++ % scans.size()];
    mapper.insert(s.scan, s.T_map_robot, changed);
    benchmark::DoNotOptimize(changed.data());
  }
  report_cells(state, scans);
}
BENCHMARK(BM_GridMapperInsert)->Unit(benchmark::kMicrosecond);

void bresenham(std::vector<std::int8_t>& cells, Cell a, Cell b, bool echo) {
  const int dx = std::abs(b.x - a.x), dy = -std::abs(b.y - a.y), sx = a.x < b.x ? 1 : -1, sy = a.y < b.y ? 1 : -1;
  const auto cell = [&](Cell c) -> std::int8_t& { return cells[static_cast<std::size_t>(c.y * kSide + c.x)]; };
  for (int error = dx + dy; a != b;) {
    cell(a) = static_cast<std::int8_t>(std::min(127, cell(a) + 12));
    const int twice = 2 * error;
    if (twice >= dy) error += dy, a.x += sx;
    if (twice <= dx) error += dx, a.y += sy;
  }
  if (echo) cell(b) = static_cast<std::int8_t>(std::max(-127, cell(b) - 48));
}

void BM_PlainBresenham(benchmark::State& state) {
  const OccupancyGrid map = pillar_hall();
  const auto scans = drive(map);
  std::vector<std::int8_t> cells(map.size(), 0);
  std::size_t i = 0;
  for (auto _ : state) {
    const auto& s = scans[i++ % scans.size()];
    const Cell start = map.geometry().cell_of(s.T_map_robot.position());
    for (std::size_t b = 0; b < s.scan.ranges.size(); ++b) {
      const double angle = s.T_map_robot.theta + s.scan.angle(b), r = s.scan.ranges[b] + 1e-6;
      const Cell end =
          map.geometry().cell_of({s.T_map_robot.x + r * std::cos(angle), s.T_map_robot.y + r * std::sin(angle)});
      if (map.contains(end)) bresenham(cells, start, end, s.scan.valid(b));
    }
    benchmark::DoNotOptimize(cells.data());
  }
  report_cells(state, scans);
}
BENCHMARK(BM_PlainBresenham)->Unit(benchmark::kMicrosecond);

}  // namespace
