#include "decision/traffic.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace outrider::decision {
namespace {

constexpr double kTouch = 1e-6;          // [m] touching is allowed
constexpr double kSearchRadius = 30.0;   // [m] nobody makes room farther away than this

}  // namespace

double distance_to_segment(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double t = length2 == 0.0 ? 0.0 : std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0);
  return std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

Traffic::Traffic(const GridGeometry& geometry, double radius) : geometry_(geometry), radius_(radius) {}

/// Everything happens in a window of the map, the square of half edge `reach` [m] around a cell.
void Traffic::look_at(const Grid<std::uint8_t>& passable, Cell around, double reach) {
  const GridGeometry& g = geometry_;
  const int most = std::max(g.width, g.height);
  const int cells = static_cast<int>(std::min(std::ceil(reach / g.resolution) + 1.0, static_cast<double>(most)));
  low_ = {std::max(around.x - cells, 0), std::max(around.y - cells, 0)};
  const Cell high{std::min(around.x + cells, g.width - 1), std::min(around.y + cells, g.height - 1)};
  const GridGeometry window{g.resolution, {g.origin.x + low_.x * g.resolution, g.origin.y + low_.y * g.resolution},
                            high.x - low_.x + 1, high.y - low_.y + 1};
  if (mask_.geometry() != window) mask_ = Grid<std::uint8_t>(window);
  for (int y = 0; y < window.height; ++y)
    std::copy_n(&passable[Cell{low_.x, low_.y + y}], window.width, &mask_[Cell{0, y}]);
}

/// Calls visit(cell of the window) for the cells whose centre is closer than `r` to the segment a-b.
template <class Visit>
void Traffic::near_segment(Point a, Point b, double r, Visit&& visit) const {
  const GridGeometry& g = geometry_;
  const Cell lo = g.cell_of({std::min(a.x, b.x) - r, std::min(a.y, b.y) - r});
  const Cell hi = g.cell_of({std::max(a.x, b.x) + r, std::max(a.y, b.y) + r});
  for (int y = std::max(lo.y, low_.y); y <= std::min(hi.y, low_.y + mask_.height() - 1); ++y)
    for (int x = std::max(lo.x, low_.x); x <= std::min(hi.x, low_.x + mask_.width() - 1); ++x)
      if (distance_to_segment(g.center({x, y}), a, b) < r - kTouch) visit(in_window({x, y}));
}

std::vector<Cell> Traffic::on_map(std::vector<Cell> path) const {
  for (Cell& c : path) c = {c.x + low_.x, c.y + low_.y};
  return path;
}

void Traffic::block(std::span<const Neighbour> neighbours, std::optional<RobotId> except) {
  for (const Neighbour& n : neighbours)
    if (n.robot != except)
      near_segment(n.position, n.position, radius_ + n.radius, [&](Cell c) { mask_[c] = 0; });
}

std::optional<std::vector<Cell>> Traffic::detour(const Grid<std::uint8_t>& passable, Cell from, Cell to, double longest,
                                                 std::span<const Neighbour> neighbours) {
  look_at(passable, to, longest);
  const Cell begin = in_window(from), end = in_window(to);
  if (!mask_.contains(begin)) return std::nullopt;
  block(neighbours, std::nullopt);
  mask_[begin] = 1;
  if (!mask_[end]) return std::nullopt;
  const Cell source[] = {end};
  field_.compute(mask_, source, longest);
  if (!field_.reached(begin)) return std::nullopt;
  return on_map(field_.path(begin));
}

/// `from` and the path in cells of the window.
std::vector<Cell> Traffic::nearest_clear(Cell from) {
  mask_[from] = 1;
  const Cell source[] = {from};
  field_.compute(mask_, source, kSearchRadius);
  std::optional<Cell> best;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < mask_.size(); ++i) {
    const Cell c = mask_.geometry().cell_at(i);
    if (!mask_[i] || on_way_[i] || !field_.reached(c) || field_.metres(c) >= nearest) continue;
    nearest = field_.metres(c);
    best = c;
  }
  if (!best) return {};
  std::vector<Cell> path = field_.path(*best);
  std::reverse(path.begin(), path.end());
  return path;
}

std::optional<Traffic::Room> Traffic::make_room(const Grid<std::uint8_t>& passable, Cell from, const Neighbour& asker,
                                                std::span<const Neighbour> neighbours, std::optional<Cell> goal) {
  look_at(passable, from, kSearchRadius);
  on_way_ = Grid<std::uint8_t>(mask_.geometry());
  const double gap = radius_ + asker.radius;
  const Point end = mark_way(asker.position, asker.way, gap);
  if (goal && asker.stays && !asker.way.empty() && mask_.contains(in_window(*goal))) {
    const Grid<std::uint8_t> on_way = on_way_;
    near_segment(end, end, gap, [&](Cell c) { mask_[c] = 0; });
    const Cell source[] = {in_window(*goal)};
    field_.compute(mask_, source);
    for (std::size_t i = 0; i < on_way_.size(); ++i) on_way_[i] |= !field_.reached(mask_.geometry().cell_at(i));
    if (auto room = room_beside(passable, from, asker, neighbours)) return room;
    on_way_ = on_way;
  }
  return room_beside(passable, from, asker, neighbours);
}

std::optional<Traffic::Room> Traffic::room_beside(const Grid<std::uint8_t>& passable, Cell from, const Neighbour& asker,
                                                  std::span<const Neighbour> neighbours) {
  look_at(passable, from, kSearchRadius);
  const Cell begin = in_window(from);
  block(neighbours, std::nullopt);
  if (auto path = on_map(nearest_clear(begin)); !path.empty()) return Room{std::move(path), std::nullopt, false};
  look_at(passable, from, kSearchRadius);
  const Neighbour only_asker[] = {asker};
  block(only_asker, std::nullopt);
  if (auto path = on_map(nearest_clear(begin)); !path.empty()) {
    const Neighbour* first = in_the_way(path, neighbours, kSearchRadius);
    return Room{std::move(path), first ? std::optional(first->robot) : std::nullopt, false};
  }
  // The asker has to leave the way out to us first, and then come back: it needs a way to do so that we do not block.
  const Grid<std::uint8_t> on_way = on_way_;
  mark_way_back(passable, from, asker);
  for (const bool with_way_back : {true, false}) {
    if (!with_way_back) on_way_ = on_way;
    look_at(passable, from, kSearchRadius);
    if (auto path = on_map(nearest_clear(begin)); !path.empty()) return Room{std::move(path), asker.robot, true};
  }
  return std::nullopt;
}

/// Marks the way to `asker` from the farthest place that it could back to.
void Traffic::mark_way_back(const Grid<std::uint8_t>& passable, Cell from, const Neighbour& asker) {
  look_at(passable, from, kSearchRadius);
  const Point at = geometry_.center(from);
  near_segment(at, at, radius_ + asker.radius, [&](Cell c) { mask_[c] = 0; });
  const Cell source[] = {in_window(geometry_.cell_of(asker.position))};
  if (!mask_.contains(source[0])) return;
  mask_[source[0]] = 1;
  field_.compute(mask_, source, kSearchRadius);
  Cell farthest = source[0];
  for (std::size_t i = 0; i < mask_.size(); ++i) {
    const Cell c = mask_.geometry().cell_at(i);
    if (field_.reached(c) && field_.metres(c) > field_.metres(farthest)) farthest = c;
  }
  std::vector<Cell> way = on_map(field_.path(farthest));
  std::reverse(way.begin(), way.end());
  mark_way(asker.position, way, radius_ + asker.radius);
}

/// Marks where this robot would be closer than `gap` [m] to somebody on the way. Returns the end of the way.
Point Traffic::mark_way(Point from, std::span<const Cell> way, double gap) {
  near_segment(from, from, gap, [&](Cell c) { on_way_[c] = 1; });
  for (const Cell next : way) {
    const Point to = geometry_.center(next);
    near_segment(from, to, gap, [&](Cell c) { on_way_[c] = 1; });
    from = to;
  }
  return from;
}

std::vector<Cell> Traffic::stroll(const Grid<std::uint8_t>& passable, Cell from, std::span<const Neighbour> neighbours,
                                  double reach, std::size_t lot) {
  look_at(passable, from, reach);
  block(neighbours, std::nullopt);
  const Cell source[] = {in_window(from)};
  mask_[source[0]] = 1;
  field_.compute(mask_, source, reach);
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < mask_.size(); ++i)
    if (field_.reached(mask_.geometry().cell_at(i))) cells.push_back(mask_.geometry().cell_at(i));
  std::vector<Cell> path = field_.path(cells[lot % cells.size()]);
  std::reverse(path.begin(), path.end());
  return on_map(std::move(path));
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
