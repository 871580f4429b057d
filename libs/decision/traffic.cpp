#include "decision/traffic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace outrider::decision {
namespace {

constexpr double kTouch = 1e-6;          // [m] touching is allowed
constexpr double kSearchRadius = 30.0;   // [m] nobody makes room farther away than this

/// Calls visit(cell) for the cells whose centre is closer than `r` to the segment a-b.
template <class Visit>
void near_segment(const GridGeometry& g, Point a, Point b, double r, Visit&& visit) {
  const Cell lo = g.cell_of({std::min(a.x, b.x) - r, std::min(a.y, b.y) - r});
  const Cell hi = g.cell_of({std::max(a.x, b.x) + r, std::max(a.y, b.y) + r});
  for (int y = std::max(lo.y, 0); y <= std::min(hi.y, g.height - 1); ++y)
    for (int x = std::max(lo.x, 0); x <= std::min(hi.x, g.width - 1); ++x)
      if (distance_to_segment(g.center({x, y}), a, b) < r - kTouch) visit(Cell{x, y});
}

}  // namespace

double distance_to_segment(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double t = length2 == 0.0 ? 0.0 : std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0);
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

Traffic::Traffic(const GridGeometry& geometry, double radius) : geometry_(geometry), radius_(radius) {}

void Traffic::block(std::span<const Neighbour> neighbours, std::optional<RobotId> except) {
  for (const Neighbour& n : neighbours)
    if (n.robot != except)
      near_segment(geometry_, n.position, n.position, radius_ + n.radius, [&](Cell c) { mask_[c] = 0; });
}

std::optional<std::vector<Cell>> Traffic::detour(const Grid<std::uint8_t>& passable, Cell from, Cell to,
                                                 std::span<const Neighbour> neighbours) {
  mask_ = passable;
  block(neighbours, std::nullopt);
  mask_[from] = 1;
  if (!mask_[to]) return std::nullopt;
  const Cell source[] = {to};
  field_.compute(mask_, source);
  if (!field_.reached(from)) return std::nullopt;
  return field_.path(from);
}

std::vector<Cell> Traffic::nearest_clear(Cell from) {
  mask_[from] = 1;
  const Cell source[] = {from};
  field_.compute(mask_, source, kSearchRadius);
  std::optional<Cell> best;
  double nearest = std::numeric_limits<double>::infinity();
  const int reach = static_cast<int>(kSearchRadius / geometry_.resolution) + 1;
  for (int y = std::max(0, from.y - reach); y <= std::min(geometry_.height - 1, from.y + reach); ++y)
    for (int x = std::max(0, from.x - reach); x <= std::min(geometry_.width - 1, from.x + reach); ++x) {
      const Cell c{x, y};
      if (!mask_[c] || on_way_[c] || !field_.reached(c) || field_.metres(c) >= nearest) continue;
      nearest = field_.metres(c);
      best = c;
    }
  if (!best) return {};
  std::vector<Cell> path = field_.path(*best);
  std::reverse(path.begin(), path.end());
  return path;
}

std::optional<Traffic::Room> Traffic::make_room(const Grid<std::uint8_t>& passable, Cell from, const Neighbour& asker,
                                                std::span<const Neighbour> neighbours) {
  on_way_ = Grid<std::uint8_t>(geometry_);
  Point a = asker.position;
  const double need = radius_ + asker.radius;
  near_segment(geometry_, a, a, need, [&](Cell c) { on_way_[c] = 1; });
  for (const Cell next : asker.way) {
    const Point b = geometry_.center(next);
    near_segment(geometry_, a, b, need, [&](Cell c) { on_way_[c] = 1; });
    a = b;
  }
  mask_ = passable;
  block(neighbours, std::nullopt);
  if (auto path = nearest_clear(from); !path.empty()) return Room{std::move(path), std::nullopt, false};
  mask_ = passable;
  const Neighbour only_asker[] = {asker};
  block(only_asker, std::nullopt);
  if (auto path = nearest_clear(from); !path.empty()) {
    const Neighbour* first = in_the_way(path, neighbours, kSearchRadius);
    return Room{std::move(path), first ? std::optional(first->robot) : std::nullopt, false};
  }
  mask_ = passable;
  if (auto path = nearest_clear(from); !path.empty()) return Room{std::move(path), asker.robot, true};
  return std::nullopt;
}

const Neighbour* Traffic::in_the_way(std::span<const Cell> way, std::span<const Neighbour> neighbours,
                                     double horizon) const {
  for (std::size_t k = 1; k < way.size(); ++k) {
    const Point a = geometry_.center(way[k - 1]), b = geometry_.center(way[k]);
    if ((static_cast<double>(k) - 1.0) * geometry_.resolution > horizon) break;
    const Neighbour* nearest = nullptr;
    for (const Neighbour& n : neighbours)
      if (distance_to_segment(n.position, a, b) < radius_ + n.radius - kTouch &&
          (nearest == nullptr || distance(n.position, a) < distance(nearest->position, a)))
        nearest = &n;
    if (nearest != nullptr) return nearest;
  }
  return nullptr;
}

}  // namespace outrider::decision
