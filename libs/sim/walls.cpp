#include "sim/walls.hpp"

#include <algorithm>
#include <cmath>

#include "world/ray.hpp"

namespace outrider::sim {
namespace {

/// Columns from each cell to the nearest solid one in its row, 0 for itself, at most `limit`; outside is solid.
Grid<int> columns_to_solid(const OccupancyGrid& truth, int limit) {
  Grid<int> columns(truth.geometry());
  for (int y = 0; y < truth.height(); ++y) {
    int run = 0;
    for (int x = 0; x < truth.width(); ++x) {
      run = truth[Cell{x, y}] != CellState::kFree ? 0 : std::min(run + 1, limit);
      columns[Cell{x, y}] = run;
    }
    run = 0;
    for (int x = truth.width() - 1; x >= 0; --x) {
      run = truth[Cell{x, y}] != CellState::kFree ? 0 : std::min(run + 1, limit);
      columns[Cell{x, y}] = std::min(columns[Cell{x, y}], run);
    }
  }
  return columns;
}

/// Squared distance from the centre of a cell to the nearest solid square [cells^2], looking `reach` rows up and down.
double squared_clearance(const Grid<int>& columns, Cell c, int reach) {
  const auto beyond_half = [](int cells) { return std::max(0.0, cells - 0.5); };
  double best = kNever;
  for (int dy = -reach; dy <= reach; ++dy) {
    const Cell beside{c.x, c.y + dy};
    const double across = columns.contains(beside) ? beyond_half(columns[beside]) : 0.0;
    const double along = beyond_half(std::abs(dy));
    best = std::min(best, across * across + along * along);
  }
  return best;
}

}  // namespace

Walls::Walls(const OccupancyGrid& truth, double radius) : truth_(&truth), radius_(radius), room_(truth.geometry()) {
  constexpr double kRounding = 1e-10, kHalfDiagonal = 0.70711;
  const double in_cells = (radius - kRounding) / truth.geometry().resolution;
  const double whole = in_cells + kHalfDiagonal;
  const int reach = static_cast<int>(std::min(std::ceil(whole + 0.5), 1.0 * std::max(truth.width(), truth.height())));
  const Grid<int> columns = columns_to_solid(truth, reach + 1);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i] != CellState::kFree) continue;
    const double clearance = squared_clearance(columns, truth.geometry().cell_at(i), reach);
    if (clearance >= in_cells * in_cells) room_[i] = clearance >= whole * whole ? Room::kWhole : Room::kCenter;
  }
}

Box Walls::square(Cell c) const {
  const GridGeometry& g = truth_->geometry();
  return {g.origin.x + c.x * g.resolution, g.origin.y + c.y * g.resolution, g.origin.x + (c.x + 1) * g.resolution,
          g.origin.y + (c.y + 1) * g.resolution};
}

bool Walls::fits(Point p) const {
  const GridGeometry& g = truth_->geometry();
  const Cell here = g.cell_of(p);
  if (!room_.contains(here)) return false;
  if (room_[here] == Room::kWhole) return true;
  const double least = radius_ - kTouchTolerance;
  const Cell low = g.cell_of({p.x - radius_, p.y - radius_}), high = g.cell_of({p.x + radius_, p.y + radius_});
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x)
      if (solid({x, y}) && distance(p, square({x, y}).nearest(p)) < least) return false;
  return true;
}

double Walls::free_length(Point from, Point to) const {
  const double length = distance(from, to);
  if (length == 0.0 || is_neighbour_step(from, to)) return length;
  const Sweep way{from, (to.x - from.x) / length, (to.y - from.y) / length};
  return all_open(way, length) ? length : std::min(length, first_contact(way, length));
}

// Why the ends are enough: between two cells in a row, the square nearest to the way is as near to one of the ends. On
// a diagonal, a point beside the way is nearer to the cell on its side than to the way, or lies in one of the four.
bool Walls::is_neighbour_step(Point from, Point to) const {
  constexpr double kRounding = 1e-10;
  const GridGeometry& g = truth_->geometry();
  const Cell a = g.cell_of(from), b = g.cell_of(to);
  if (std::max(std::abs(a.x - b.x), std::abs(a.y - b.y)) > 1) return false;
  if (distance(from, g.center(a)) > kRounding || distance(to, g.center(b)) > kRounding) return false;
  return passable(a) && passable(b) && passable({a.x, b.y}) && passable({b.x, a.y});
}

bool Walls::all_open(const Sweep& way, double length) const {
  bool open = room_.contains(room_.geometry().cell_of(way.at(length)));
  walk_ray(room_.geometry(), way.from, way.dx, way.dy, length, [&](Cell c, double) {
    open = open && room_[c] == Room::kWhole;
    return open;
  });
  return open;
}

double Walls::first_contact(const Sweep& way, double length) const {
  const GridGeometry& g = truth_->geometry();
  const double radius = radius_ - kStopDepth;
  const Point end = way.at(length);
  // One ring of solid squares around the grid stands for all that is outside.
  const auto column = [&](double x) { return std::clamp(g.cell_of({x, 0.0}).x, -1, g.width); };
  const auto row = [&](double y) { return std::clamp(g.cell_of({0.0, y}).y, -1, g.height); };
  double first = kNever;
  const int last_row = row(std::max(way.from.y, end.y) + radius_);
  for (int y = row(std::min(way.from.y, end.y) - radius_); y <= last_row; ++y) {
    // The part of the way that is within reach of this row.
    double begin = 0.0, stop = length;
    if (way.dy != 0.0) {
      const double a = (square({0, y}).y0 - radius_ - way.from.y) / way.dy;
      const double b = (square({0, y}).y1 + radius_ - way.from.y) / way.dy;
      begin = std::clamp(std::min(a, b), 0.0, length);
      stop = std::clamp(std::max(a, b), 0.0, length);
    }
    const double xa = way.at(begin).x, xb = way.at(stop).x;
    const double left = std::min(xa, xb), right = std::max(xa, xb);
    const int last_column = column(right + radius_);
    for (int x = column(left - radius_); x <= last_column; ++x)
      if (solid({x, y})) first = std::min(first, entry_into_grown_box(way, square({x, y}), radius));
  }
  return first;
}

}  // namespace outrider::sim
