#include "explorer/lower_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "decision/distance_field.hpp"
#include "explorer/mission.hpp"

namespace outrider::explorer {
namespace {

constexpr double kMostStraightLines = 5e7;  // starts x cells; with more, the ways on the map alone must do

/// Lattice points within `reach` cells of (0, 0) but not of (-step): what a step shows at most.
int newly_in_view(double reach, Cell step) {
  const int extent = static_cast<int>(reach);
  const auto within = [&](int x, int y) { return x * x + y * y <= reach * reach * (1.0 + 1e-12); };
  int cells = 0;
  for (int y = -extent; y <= extent; ++y)
    for (int x = -extent; x <= extent; ++x) cells += within(x, y) && !within(x + step.x, y + step.y);
  return cells;
}

/// Robots of one speed and range.
struct RobotClass {
  double speed, range;  // [m/s], [m]
  std::vector<Cell> starts;
};

std::vector<RobotClass> classes_of(const std::vector<RobotSpec>& team, const GridGeometry& g) {
  std::map<std::pair<double, double>, std::vector<Cell>> starts;
  for (const RobotSpec& robot : team) starts[{robot.speed, robot.range}].push_back(g.cell_of(robot.start.position()));
  std::vector<RobotClass> classes;
  for (auto& [abilities, cells] : starts) classes.push_back({abilities.first, abilities.second, std::move(cells)});
  return classes;
}

/// Cells that a robot of this class newly sees in a second at most, and those of one step more.
struct Sweep {
  double cells_per_s, cells_per_step;
};

Sweep sweep_of(const RobotClass& c, double resolution, bool lidar) {
  // A ray within range touches cells whose squares lie within range + sqrt 2 edges of the robot.
  const double reach = c.range / resolution + (lidar ? std::sqrt(2.0) : 0.0);
  if (lidar) return {c.speed / resolution * 2.0 * reach, 2.0 * reach};
  const int straight = newly_in_view(reach, {1, 0}), diagonal = newly_in_view(reach, {1, 1});
  return {c.speed / resolution * std::max<double>(straight, diagonal / std::sqrt(2.0)),
          static_cast<double>(std::max(straight, diagonal))};
}

/// When each cell can have been seen at the earliest; lowers what is in `earliest` [s].
void lower_earliest(const RobotClass& c, const Grid<std::uint8_t>& open, Grid<double>& earliest) {
  const GridGeometry& g = earliest.geometry();
  decision::DistanceField field;
  field.compute(open, c.starts);
  // On the way to c along free cells at most 4-connected steps are needed from where it is seen: sqrt 2 times the
  // range.
  const double seen_way = std::sqrt(2.0) * c.range + 2.0 * g.resolution, seen_straight = c.range + 2.0 * g.resolution;
  const bool lines = static_cast<double>(c.starts.size()) * static_cast<double>(g.size()) <= kMostStraightLines;
  for (std::size_t i = 0; i < earliest.size(); ++i) {
    const Cell cell = g.cell_at(i);
    double metres = std::max(0.0, field.metres(cell) - seen_way);
    if (lines) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Cell s : c.starts) nearest = std::min(nearest, distance(g.center(s), g.center(cell)));
      metres = std::max(metres, nearest - seen_straight);
    }
    earliest[i] = std::min(earliest[i], metres / c.speed);
  }
}

}  // namespace

double lower_bound_s(const OccupancyGrid& truth, const std::vector<RobotSpec>& team, double fraction, bool lidar) {
  const GridGeometry& g = truth.geometry();
  Grid<std::uint8_t> open(g);
  for (std::size_t i = 0; i < truth.size(); ++i) open[i] = truth[i] == CellState::kFree;
  Grid<double> earliest(g, std::numeric_limits<double>::infinity());
  double rate = 0.0, margin = 0.0;
  for (const RobotClass& c : classes_of(team, g)) {
    const Sweep sweep = sweep_of(c, g.resolution, lidar);
    rate += static_cast<double>(c.starts.size()) * sweep.cells_per_s;
    margin += static_cast<double>(c.starts.size()) * sweep.cells_per_step;
    if (c.speed > 0.0) lower_earliest(c, open, earliest);
  }
  const Grid<std::uint8_t> reachable = reachable_area(truth, team);
  std::vector<double> times;  // of the cells that count, ascending
  for (std::size_t i = 0; i < reachable.size(); ++i)
    if (reachable[i]) times.push_back(earliest[i]);
  std::sort(times.begin(), times.end());
  const auto aim = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(times.size()) - 1e-9));
  double bound = 0.0;
  const auto later = std::upper_bound(times.begin(), times.end(), 0.0) - times.begin();
  for (auto k = static_cast<std::size_t>(later); k < aim; ++k)  // just before times[k], k cells can have been seen
    bound = std::max(bound, times[k] + std::max(0.0, (static_cast<double>(aim - k) - margin) / rate));
  return bound;
}

}  // namespace outrider::explorer
