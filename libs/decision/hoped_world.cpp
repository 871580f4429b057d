#include "decision/hoped_world.hpp"

#include <algorithm>
#include <cmath>

#include "world/ray.hpp"

namespace outrider::decision {
namespace {

constexpr Cell kSides[] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};

/// Rays of a sensor as offsets of cells, dense enough that neighbouring ones stay within `gap` cells at the far end.
std::vector<std::vector<Cell>> rays_of(double range_cells, double gap) {
  const int n = std::max(16, static_cast<int>(std::ceil(2.0 * kPi * range_cells / gap)));
  const int reach = static_cast<int>(range_cells) + 2;
  const GridGeometry local{1.0, {-(reach + 0.5), -(reach + 0.5)}, 2 * reach + 1, 2 * reach + 1};
  std::vector<std::vector<Cell>> rays;
  for (int i = 0; i < n; ++i) {
    const double angle = 2.0 * kPi * (i + 0.5) / n;
    std::vector<Cell> ray;
    walk_ray(local, {0.0, 0.0}, std::cos(angle), std::sin(angle), range_cells, [&](Cell c, double) {
      const Cell offset{c.x - reach, c.y - reach};
      if (offset.x * offset.x + offset.y * offset.y <= range_cells * range_cells) ray.push_back(offset);
      return true;
    });
    rays.push_back(std::move(ray));
  }
  return rays;
}

}  // namespace

HopedWorld::HopedWorld(const GridGeometry& geometry, int block_cells, int pixel_cells)
    : geometry_(geometry),
      blocks_{geometry.resolution * block_cells, geometry.origin, (geometry.width + block_cells - 1) / block_cells,
              (geometry.height + block_cells - 1) / block_cells},
      block_(block_cells),
      pixel_(pixel_cells),
      tiles_across_(geometry.width / pixel_cells / 8 + 1),
      map_(geometry),
      passable_(geometry),
      part_(geometry, -1),
      places_(blocks_.size() * kMostParts, Cell{-1, -1}),
      edges_(places_.size()),
      hopes_(places_.size()),
      fringe_(blocks_.size()),
      reached_(places_.size()),
      unseen_(static_cast<std::size_t>(tiles_across_ * (geometry.height / pixel_cells / 8 + 1))),
      vain_(unseen_.size()) {
  for (std::size_t i = 0; i < blocks_.size(); ++i) relabel(blocks_.cell_at(i));
  for (std::size_t i = 0; i < blocks_.size(); ++i) connect(blocks_.cell_at(i));
}

std::uint32_t HopedWorld::tile_of(Cell c) const {
  return static_cast<std::uint32_t>(c.y / pixel_ / 8 * tiles_across_ + c.x / pixel_ / 8);
}

std::uint64_t HopedWorld::pixel_of(Cell c) const {
  return std::uint64_t{1} << (c.y / pixel_ % 8 * 8 + c.x / pixel_ % 8);
}

void HopedWorld::add(std::vector<Patch>& patches, std::uint32_t tile, std::uint64_t pixel) {
  for (Patch& patch : patches)
    if (patch.tile == tile) {
      patch.pixels |= pixel;
      return;
    }
  patches.push_back({tile, pixel});
}

bool HopedWorld::open(Cell c) const { return map_[c] == CellState::kUnknown || passable_[c] != 0; }

void HopedWorld::update(const OccupancyGrid& map, const Grid<std::uint8_t>& passable) {
  Grid<std::uint8_t> dirty(blocks_);
  std::vector<Cell> changed_blocks;
  const auto mark = [&](Cell block) {
    if (!blocks_.contains(block) || dirty[block]) return;
    dirty[block] = 1;
    changed_blocks.push_back(block);
  };
  Grid<std::uint8_t> walled(blocks_);
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] == map_[i] && passable[i] == passable_[i]) continue;
    const Cell c = geometry_.cell_at(i);
    if ((map[i] == CellState::kOccupied) != (map_[i] == CellState::kOccupied)) walled[block_of(c)] = 1;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (const Cell n{c.x + dx, c.y + dy}; geometry_.contains(n)) mark(block_of(n));
  }
  if (changed_blocks.empty()) return;
  ++revision_;
  map_ = map;
  passable_ = passable;
  for (const Cell block : changed_blocks) relabel(block);
  const std::size_t changed = changed_blocks.size();
  for (std::size_t k = 0; k < changed; ++k) {
    const Cell block = changed_blocks[k];
    if (walled[block]) invalidate_views(block);
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) mark({block.x + dx, block.y + dy});
  }
  for (const Cell block : changed_blocks) connect(block);
}

/// Divides a block into its connected parts.
void HopedWorld::relabel(Cell block) {
  const Cell lo{block.x * block_, block.y * block_};
  const Cell hi{std::min(lo.x + block_, geometry_.width), std::min(lo.y + block_, geometry_.height)};
  const auto first = static_cast<Node>(blocks_.index(block)) * kMostParts;
  for (Node n = first; n < first + kMostParts; ++n) {
    places_[index(n)] = {-1, -1};
    edges_[index(n)].clear();
    hopes_[index(n)].clear();
  }
  for (int y = lo.y; y < hi.y; ++y)
    for (int x = lo.x; x < hi.x; ++x) part_[Cell{x, y}] = -1;
  int parts = 0;
  for (int y = lo.y; y < hi.y; ++y)
    for (int x = lo.x; x < hi.x && parts < kMostParts; ++x) {
      if (part_[Cell{x, y}] >= 0 || !open({x, y})) continue;
      flood_.assign(1, {x, y});
      part_[Cell{x, y}] = static_cast<std::int8_t>(parts);
      for (std::size_t k = 0; k < flood_.size(); ++k)
        for (const Cell d : kSides) {
          const Cell n{flood_[k].x + d.x, flood_[k].y + d.y};
          if (n.x < lo.x || n.y < lo.y || n.x >= hi.x || n.y >= hi.y || part_[n] >= 0 || !open(n)) continue;
          part_[n] = static_cast<std::int8_t>(parts);
          flood_.push_back(n);
        }
      describe(first + parts++, flood_);
    }
  note_fringe(block);
}

/// A node's place is its cell nearest to the middle of its cells; known ones come first.
void HopedWorld::describe(Node n, std::span<const Cell> cells) {
  double x = 0.0, y = 0.0;
  for (const Cell c : cells) {
    x += c.x;
    y += c.y;
    if (map_[c] == CellState::kUnknown) add(hopes_[index(n)], tile_of(c), pixel_of(c));
  }
  x /= static_cast<double>(cells.size());
  y /= static_cast<double>(cells.size());
  const auto away = [&](Cell c) { return std::hypot(c.x - x, c.y - y); };
  places_[index(n)] = *std::min_element(cells.begin(), cells.end(), [&](Cell a, Cell b) { return away(a) < away(b); });
  for (Sensor& sensor : sensors_) sensor.valid[index(n)] = 0;
}

void HopedWorld::note_fringe(Cell block) {
  auto& fringe = fringe_[blocks_.index(block)];
  fringe.clear();
  const Cell lo{block.x * block_, block.y * block_};
  for (int y = lo.y; y < std::min(lo.y + block_, geometry_.height); ++y)
    for (int x = lo.x; x < std::min(lo.x + block_, geometry_.width); ++x) {
      if (map_[Cell{x, y}] != CellState::kUnknown) continue;
      for (int k = 0; k < 9; ++k)
        if (const Cell n{x + k % 3 - 1, y + k / 3 - 1}; geometry_.contains(n) && map_[n] == CellState::kFree) {
          add(fringe, tile_of({x, y}), pixel_of({x, y}));
          break;
        }
    }
}

void HopedWorld::join(Cell inside, Cell outside) {
  const Node a = node_at(inside), b = node_at(outside);
  if (a == kNone || b == kNone) return;
  auto& edges = edges_[index(a)];
  if (std::any_of(edges.begin(), edges.end(), [&](const Edge& e) { return e.to == b; })) return;
  edges.push_back({b, static_cast<float>(straight_m(a, b))});
}

/// Edges of a block's nodes to those of the eight blocks around.
void HopedWorld::connect(Cell block) {
  const auto first = static_cast<Node>(blocks_.index(block)) * kMostParts;
  for (Node n = first; n < first + kMostParts; ++n) edges_[index(n)].clear();
  const Cell lo{block.x * block_, block.y * block_};
  const Cell hi{std::min(lo.x + block_, geometry_.width) - 1, std::min(lo.y + block_, geometry_.height) - 1};
  for (int y = lo.y; y <= hi.y; ++y) {
    join({lo.x, y}, {lo.x - 1, y});
    join({hi.x, y}, {hi.x + 1, y});
  }
  for (int x = lo.x; x <= hi.x; ++x) {
    join({x, lo.y}, {x, lo.y - 1});
    join({x, hi.y}, {x, hi.y + 1});
  }
  for (const Cell corner : {lo, Cell{lo.x, hi.y}, Cell{hi.x, lo.y}, hi})
    for (const Cell d : {Cell{1, 1}, Cell{1, -1}, Cell{-1, 1}, Cell{-1, -1}}) {
      const Cell out{corner.x + d.x, corner.y + d.y};
      if (block_of(out).x == block.x || block_of(out).y == block.y || !geometry_.contains(out)) continue;
      if (open({out.x, corner.y}) && open({corner.x, out.y})) join(corner, out);
    }
}

void HopedWorld::invalidate_views(Cell block) {
  for (Sensor& sensor : sensors_) {
    const int reach = sensor.reach / block_ + 1;
    for (int y = std::max(0, block.y - reach); y <= std::min(blocks_.height - 1, block.y + reach); ++y)
      for (int x = std::max(0, block.x - reach); x <= std::min(blocks_.width - 1, block.x + reach); ++x) {
        const std::size_t first = blocks_.index({x, y}) * kMostParts;
        std::fill_n(sensor.valid.begin() + static_cast<std::ptrdiff_t>(first), kMostParts, std::uint8_t{0});
      }
  }
}

void HopedWorld::look_from(Cell at) {
  std::fill(reached_.begin(), reached_.end(), std::uint8_t{0});
  std::fill(unseen_.begin(), unseen_.end(), 0);
  unknown_nodes_.clear();
  queue_.clear();
  const auto reach = [&](Node n) {
    if (reached_[index(n)]) return;
    reached_[index(n)] = 1;
    queue_.push_back(n);
  };
  if (const Node start = node_at(at); start != kNone) reach(start);
  for (std::size_t k = 0; k < queue_.size(); ++k) {
    const Node n = queue_[k];
    for (const Edge& edge : edges_[index(n)]) reach(edge.to);
    for (const Patch& patch : hopes_[index(n)]) unseen_[patch.tile] |= patch.pixels;
    if (!hopes_[index(n)].empty()) unknown_nodes_.push_back(n);
  }
  for (const auto& fringe : fringe_)
    for (const Patch& patch : fringe) unseen_[patch.tile] |= patch.pixels;
  for (std::size_t tile = 0; tile < unseen_.size(); ++tile) unseen_[tile] &= ~vain_[tile];
}

HopedWorld::Node HopedWorld::node_at(Cell c) const {
  if (!geometry_.contains(c) || part_[c] < 0) return kNone;
  return static_cast<Node>(blocks_.index(block_of(c))) * kMostParts + part_[c];
}

HopedWorld::Node HopedWorld::node_near(Cell c, int most_cells) const {
  if (const Node n = node_at(c); n != kNone && reachable(n)) return n;
  Node best = kNone;
  int nearest = most_cells * most_cells + 1;
  for (int dy = -most_cells; dy <= most_cells; ++dy)
    for (int dx = -most_cells; dx <= most_cells; ++dx) {
      if (dx * dx + dy * dy >= nearest) continue;
      const Node n = node_at({c.x + dx, c.y + dy});
      if (n == kNone || !reachable(n)) continue;
      best = n;
      nearest = dx * dx + dy * dy;
    }
  return best;
}

double HopedWorld::straight_m(Node a, Node b) const {
  const Cell p = place(a), q = place(b);
  return std::hypot(p.x - q.x, p.y - q.y) * geometry_.resolution;
}

int HopedWorld::range_class(double range) {
  for (std::size_t k = 0; k < sensors_.size(); ++k)
    if (sensors_[k].range == range) return static_cast<int>(k);
  Sensor sensor;
  sensor.range = range;
  const double cells = std::min(range / geometry_.resolution, std::hypot(geometry_.width, geometry_.height));
  sensor.reach = static_cast<int>(cells) + 1;
  sensor.rays = rays_of(cells, pixel_);
  sensor.views.resize(places_.size());
  sensor.valid.resize(places_.size());
  sensors_.push_back(std::move(sensor));
  return static_cast<int>(sensors_.size()) - 1;
}

std::span<const HopedWorld::Patch> HopedWorld::view(int range_class, Node n) {
  Sensor& sensor = sensors_[static_cast<std::size_t>(range_class)];
  auto& view = sensor.views[index(n)];
  if (sensor.valid[index(n)]) return view;
  sensor.valid[index(n)] = 1;
  view.clear();
  const Cell from = place(n);
  for (const auto& ray : sensor.rays)
    for (const Cell offset : ray) {
      const Cell c{from.x + offset.x, from.y + offset.y};
      if (!geometry_.contains(c) || map_[c] == CellState::kOccupied) break;
      add(view, tile_of(c), pixel_of(c));
    }
  return view;
}

void HopedWorld::give_up(std::span<const Patch> patches) {
  for (const Patch& patch : patches) {
    vain_[patch.tile] |= patch.pixels & unseen_[patch.tile];
    unseen_[patch.tile] &= ~patch.pixels;
  }
}

}  // namespace outrider::decision
