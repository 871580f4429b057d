#include "decision/passability.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "world/error.hpp"

namespace outrider::decision {
namespace {

constexpr double kMaxRadiusCells = 64.0;  // keeps the count of forbidding cells within 14 bits

/// Row `y` of a mask cleared over [begin, end), clipped to the grid.
void clear_row(Grid<std::uint8_t>& mask, int y, int begin, int end) {
  if (y < 0 || y >= mask.height()) return;
  begin = std::max(begin, 0);
  end = std::min(end, mask.width());
  if (begin < end) std::fill_n(&mask[Cell{begin, y}], end - begin, std::uint8_t{0});
}

/// Calls visit(cell) once for each cell that is too near to the edge of the map, as if occupied cells lay around it.
template <class Visit>
void for_border(const GridGeometry& g, const std::vector<int>& half_widths, Visit&& visit) {
  const int margin = half_widths.empty() ? 0 : half_widths.front() - 1;
  for (int y = 0; y < g.height; ++y) {
    const bool whole_row = y < margin || y >= g.height - margin;
    for (int x = 0; x < g.width; ++x) {
      if (!whole_row && x >= margin && x < g.width - margin) x = g.width - margin;
      if (x < g.width) visit(Cell{x, y});
    }
  }
}

}  // namespace

std::vector<int> forbidden_half_widths(double radius_m, double resolution) {
  const double diameter = 2.0 * radius_m / resolution;
  if (!(radius_m >= 0.0) || !(diameter <= 2.0 * kMaxRadiusCells))
    throw InputError("robot radius " + std::to_string(radius_m) + " m: expected 0 to " +
                     std::to_string(kMaxRadiusCells * resolution) + " m on a grid of " + std::to_string(resolution) +
                     " m cells");
  // In half cells the distance to a square at offset (dx, dy) is the length of (2|dx| - 1, 2|dy| - 1), negative parts
  // counting as zero: whole numbers. The small margin lets a robot touch whose radius misses an edge by rounding.
  const double limit = diameter * diameter * (1.0 - 1e-9);
  std::vector<int> half_widths;
  for (int dy = 0;; ++dy) {
    int half = 0;
    const auto gap = [](int d) { return static_cast<double>(std::max(2 * d - 1, 0)); };
    while (gap(half) * gap(half) + gap(dy) * gap(dy) < limit) ++half;
    if (half == 0) break;
    half_widths.push_back(half);
  }
  return half_widths;
}

Passability::Passability(const GridGeometry& geometry, double radius_m)
    : radius_(radius_m),
      half_widths_(forbidden_half_widths(radius_m, geometry.resolution)),
      cells_(geometry),
      mask_(geometry) {
  static_assert(static_cast<int>(CellState::kUnknown) == 0);
  for_border(geometry, half_widths_, [&](Cell c) { cells_[c] = 1; });
}

std::span<const std::uint32_t> Passability::update(const OccupancyGrid& map, std::span<const std::uint32_t> changed) {
  assert(map.geometry() == mask_.geometry());
  changed_.clear();
  for (const std::uint32_t index : changed) {
    const CellState before = known(index), now = map[index];
    if (before == now) continue;
    cells_[index] = static_cast<std::uint16_t>(obstacles(index) | static_cast<unsigned>(now) << kStateShift);
    if (before == CellState::kOccupied) remove_obstacle(mask_.geometry().cell_at(index));
    if (now == CellState::kOccupied) add_obstacle(mask_.geometry().cell_at(index));
    set(index, now == CellState::kFree && obstacles(index) == 0);
  }
  return changed_;
}

void Passability::set(std::size_t index, bool passable) {
  const auto value = static_cast<std::uint8_t>(passable);
  if (mask_[index] == value) return;
  mask_[index] = value;
  changed_.push_back(static_cast<std::uint32_t>(index));
}

/// Calls operation(begin, end) with the index range of every row piece that an obstacle at `c` forbids.
template <class RowOperation>
void Passability::for_rows_around(Cell c, RowOperation&& operation) {
  const GridGeometry& g = mask_.geometry();
  const int reach = static_cast<int>(half_widths_.size()) - 1;
  for (int y = std::max(c.y - reach, 0); y <= std::min(c.y + reach, g.height - 1); ++y) {
    const int half = half_widths_[static_cast<std::size_t>(std::abs(y - c.y))];
    const std::size_t begin = g.index({std::max(c.x - half + 1, 0), y});
    operation(begin, g.index({std::min(c.x + half, g.width) - 1, y}) + 1);
  }
}

void Passability::add_obstacle(Cell c) {
  for_rows_around(c, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      ++cells_[i];
      set(i, false);
    }
  });
}

void Passability::remove_obstacle(Cell c) {
  for_rows_around(c, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      --cells_[i];
      set(i, obstacles(i) == 0 && known(i) == CellState::kFree);
    }
  });
}

Grid<std::uint8_t> passable_mask(const OccupancyGrid& map, double radius_m) {
  const std::vector<int> half_widths = forbidden_half_widths(radius_m, map.geometry().resolution);
  Grid<std::uint8_t> mask(map.geometry());
  for (std::size_t i = 0; i < map.size(); ++i) mask[i] = map[i] == CellState::kFree;
  const int reach = static_cast<int>(half_widths.size()) - 1;
  const auto occupied = [&](int x, int y) { return map[Cell{x, y}] == CellState::kOccupied; };
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) {
      if (!occupied(x, y)) continue;
      const int begin = x;
      while (x + 1 < map.width() && occupied(x + 1, y)) ++x;
      for (int dy = -reach; dy <= reach; ++dy) {
        const int half = half_widths[static_cast<std::size_t>(std::abs(dy))];
        clear_row(mask, y + dy, begin - half + 1, x + half);
      }
    }
  for_border(map.geometry(), half_widths, [&](Cell c) { mask[c] = 0; });
  return mask;
}

bool step_allowed(const Grid<std::uint8_t>& mask, Cell from, Cell to) {
  assert(std::abs(to.x - from.x) <= 1 && std::abs(to.y - from.y) <= 1);
  const auto passable = [&](Cell c) { return mask.contains(c) && mask[c] != 0; };
  return passable(from) && passable(to) && passable({from.x, to.y}) && passable({to.x, from.y});
}

std::optional<Cell> nearest_passable(const Grid<std::uint8_t>& mask, Cell c, int max_cells) {
  std::optional<Cell> best;
  auto best_squared = static_cast<std::int64_t>(max_cells) * max_cells + 1;
  const auto look_at = [&](int dx, int dy) {
    const Cell n{c.x + dx, c.y + dy};
    const std::int64_t squared = static_cast<std::int64_t>(dx) * dx + static_cast<std::int64_t>(dy) * dy;
    if (squared > best_squared || !mask.contains(n) || mask[n] == 0) return;
    if (squared == best_squared && (!best || mask.geometry().index(*best) < mask.geometry().index(n))) return;
    best = n;
    best_squared = squared;
  };
  // Square rings; a ring's cells are at least its number away.
  for (int ring = 0; static_cast<std::int64_t>(ring) * ring <= best_squared && ring <= max_cells; ++ring)
    for (int along = -ring; along <= ring; ++along) {
      look_at(along, -ring);
      look_at(along, ring);
      look_at(-ring, along);
      look_at(ring, along);
    }
  return best;
}

}  // namespace outrider::decision
