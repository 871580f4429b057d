#include "explorer/frontier_tasks.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "world/cell_finder.hpp"

namespace outrider::explorer {
namespace {

constexpr int kTile = 16;  // about the edge of a tile [cells]

bool row_major(Cell a, Cell b) { return std::tie(a.y, a.x) < std::tie(b.y, b.x); }

/// Cells from `low` to `high`, both included.
struct Box {
  Cell low{0, 0}, high{-1, -1};
  bool holds(Cell c) const { return low.x <= c.x && c.x <= high.x && low.y <= c.y && c.y <= high.y; }
};

/// The block of `edge` cells that `c` is in, without `margin` cells on all sides.
Box block_around(Cell c, int edge, int margin) {
  const Cell low{c.x / edge * edge, c.y / edge * edge};
  return {{low.x + margin, low.y + margin}, {low.x + edge - 1 - margin, low.y + edge - 1 - margin}};
}

/// A grid of blocks of `edge` cells that covers a grid.
GridGeometry blocks_of(const GridGeometry& g, int edge) {
  return {.resolution = g.resolution * edge, .origin = g.origin, .width = (g.width + edge - 1) / edge,
          .height = (g.height + edge - 1) / edge};
}

}  // namespace

FrontierTasks::FrontierTasks(const RobotSpec& spec, const OccupancyGrid& map)
    : map_(map),
      geometry_(map.geometry()),
      least_(static_cast<std::size_t>(std::max(1.0, std::ceil(spec.radius / geometry_.resolution - 1e-9)))),
      footprint_(spec.range, geometry_),
      most_gain_(kPi * spec.range * spec.range * (1.0 + 1e-6)),
      least_gain_(0.25 * kPi * spec.radius * spec.radius),
      revision_edge_(static_cast<int>(std::min(spec.range / geometry_.resolution, 1e6)) + 1),
      revisions_(blocks_of(geometry_, revision_edge_)) {
  if (least_gain_ < 0.5 * geometry_.cell_area()) least_gain_ = 0.0;
}

void FrontierTasks::update(std::span<const std::uint32_t> changed, std::span<const std::uint32_t> mask_changed) {
  ++revision_;
  CellFinder cell_at(geometry_);
  Box block, inside;  // what has been marked lately
  for (const std::uint32_t i : changed) {
    const Cell c = cell_at(i);
    if (!block.holds(c)) {
      revisions_[Cell{c.x / revision_edge_, c.y / revision_edge_}] = revision_;
      block = block_around(c, revision_edge_, 0);
    }
    if (block_ == 0 || inside.holds(c)) continue;
    for (int y = std::max(c.y - 1, 0) / edge_; y <= std::min(c.y + 1, geometry_.height - 1) / edge_; ++y)
      for (int x = std::max(c.x - 1, 0) / edge_; x <= std::min(c.x + 1, geometry_.width - 1) / edge_; ++x)
        tiles_[Cell{x, y}].dirty = true;
    inside = block_around(c, edge_, 1);
  }
  if (block_ <= 1) return;
  Box tile;
  for (const std::uint32_t i : mask_changed) {  // a block's task may move to a cell that can be stood on
    const Cell c = cell_at(i);
    if (tile.holds(c)) continue;
    tile_of(c).dirty = true;
    tile = block_around(c, edge_, 0);
  }
}

FrontierTasks::Tile& FrontierTasks::tile_of(Cell c) { return tiles_[Cell{c.x / edge_, c.y / edge_}]; }

void FrontierTasks::set_spacing(double spacing) {
  const int block = std::max(1, static_cast<int>(spacing / geometry_.resolution));
  if (block == block_) return;
  block_ = block;
  edge_ = block * std::max(1, kTile / block);
  tiles_ = Grid<Tile>(blocks_of(geometry_, edge_));
}

std::pair<Cell, Cell> FrontierTasks::tiles_around(Cell at, double reach) const {
  const int most = std::max(geometry_.width, geometry_.height);
  const int cells = static_cast<int>(std::min(std::ceil(reach / geometry_.resolution) + 1.0, static_cast<double>(most)));
  return {{std::max(at.x - cells, 0) / edge_, std::max(at.y - cells, 0) / edge_},
          {std::min(at.x + cells, geometry_.width - 1) / edge_, std::min(at.y + cells, geometry_.height - 1) / edge_}};
}

/// Finds the tile's tasks; those that were there before keep what is known of them.
void FrontierTasks::cut(Tile& tile, Cell at, const decision::Passability& passable) {
  std::vector<FrontierTask> tasks;
  const Cell low{at.x * edge_, at.y * edge_};
  const Cell high{std::min(low.x + edge_, geometry_.width), std::min(low.y + edge_, geometry_.height)};
  if (block_ == 1) {
    for_open(low, high, [&](Cell c) { tasks.push_back({.cell = c, .lone = 1 < least_}); });
  } else {
    for (int y = low.y; y < high.y; y += block_)
      for (int x = low.x; x < high.x; x += block_)
        cut_block({x, y}, {std::min(x + block_, high.x), std::min(y + block_, high.y)}, passable, tasks);
    std::sort(tasks.begin(), tasks.end(), [](const auto& a, const auto& b) { return row_major(a.cell, b.cell); });
  }
  auto old = tile.tasks.begin();
  for (FrontierTask& task : tasks) {
    while (old != tile.tasks.end() && row_major(old->cell, task.cell)) ++old;
    if (old == tile.tasks.end() || old->cell != task.cell) continue;
    const bool lone = task.lone;
    task = *old;
    task.lone = lone;
  }
  tile.tasks = std::move(tasks);
  tile.dirty = false;
}

/// Visits the frontier cells of [low, high) that were neither given up nor deferred, row by row.
template <class Visit>
void FrontierTasks::for_open(Cell low, Cell high, Visit&& visit) const {
  decision::for_frontier(map_, low, high, [&](Cell c) {
    const std::size_t index = geometry_.index(c);
    if ((given_up_.empty() || !given_up_.contains(index)) && (deferred_.empty() || !deferred_.contains(index))) visit(c);
  });
}

void FrontierTasks::cut_block(Cell low, Cell high, const decision::Passability& passable,
                              std::vector<FrontierTask>& tasks) const {
  std::vector<Cell> open_cells;
  for_open(low, high, [&](Cell c) { open_cells.push_back(c); });
  while (!open_cells.empty()) {
    std::vector<Cell> piece{open_cells.front()};
    open_cells.erase(open_cells.begin());
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const auto touches = [at = piece[k]](Cell c) { return std::abs(c.x - at.x) <= 1 && std::abs(c.y - at.y) <= 1; };
      std::copy_if(open_cells.begin(), open_cells.end(), std::back_inserter(piece), touches);
      std::erase_if(open_cells, touches);
    }
    std::sort(piece.begin(), piece.end(), row_major);
    const auto first = std::find_if(piece.begin(), piece.end(), [&](Cell c) { return passable.passable(c); });
    tasks.push_back({.cell = first == piece.end() ? piece.front() : *first, .lone = piece.size() < least_});
  }
}

double FrontierTasks::gain(FrontierTask& task, Cell stand, bool whole) const {
  const Cell block{stand.x / revision_edge_, stand.y / revision_edge_};
  std::uint64_t newest = 0;
  for (int y = std::max(block.y - 1, 0); y <= std::min(block.y + 1, revisions_.height() - 1); ++y)
    for (int x = std::max(block.x - 1, 0); x <= std::min(block.x + 1, revisions_.width() - 1); ++x)
      newest = std::max(newest, revisions_[Cell{x, y}]);
  if (task.stand == stand && task.revision >= newest) return task.gain;
  task.stand = stand;
  task.revision = revision_;
  task.unseen = footprint_.unseen_area(map_, stand);
  return task.gain = whole ? footprint_.area(map_, stand) : task.unseen;
}

/// At least `least_` frontier cells hang together (8 neighbours) with frontier cell `c`. O(least_^2).
bool FrontierTasks::has_company(Cell c) const {
  std::vector<Cell> found{c};
  for (std::size_t k = 0; k < found.size() && found.size() < least_; ++k)
    decision::for_frontier(map_, {std::max(found[k].x - 1, 0), std::max(found[k].y - 1, 0)},
                           {std::min(found[k].x + 2, geometry_.width), std::min(found[k].y + 2, geometry_.height)},
                           [&](Cell n) {
                             if (std::find(found.begin(), found.end(), n) == found.end()) found.push_back(n);
                           });
  return found.size() >= least_;
}

bool FrontierTasks::frontier_near(Cell c, double spacing) const {
  if (is_frontier(c)) return true;
  const int reach = block_reach(spacing);
  for (int y = c.y - reach; y <= c.y + reach; ++y)
    for (int x = c.x - reach; x <= c.x + reach; ++x)
      if (is_frontier({x, y})) return true;
  return false;
}

/// Visits the frontier cells, by index, within a block's reach of `task`, whose tiles are to be cut anew.
template <class Visit>
void FrontierTasks::for_block(Cell task, double spacing, Visit&& visit) {
  const int reach = block_reach(spacing);
  for (int y = task.y - reach; y <= task.y + reach; ++y)
    for (int x = task.x - reach; x <= task.x + reach; ++x) {
      if (!is_frontier({x, y})) continue;
      visit(geometry_.index({x, y}));
      if (block_ != 0) tile_of({x, y}).dirty = true;
    }
}

void FrontierTasks::give_up(Cell c, bool tried) {
  given_up_[geometry_.index(c)] |= tried;
  if (block_ != 0) tile_of(c).dirty = true;
}

void FrontierTasks::give_up_around(Cell task, double spacing) {
  for_block(task, spacing, [&](std::size_t index) { given_up_.try_emplace(index, false); });
}

void FrontierTasks::defer(Cell task, double spacing, double until_s) {
  for_block(task, spacing, [&](std::size_t index) { deferred_[index] = until_s; });
}

bool FrontierTasks::any_deferred(double now_s) {
  bool waits = false;
  std::erase_if(deferred_, [&](const auto& entry) {
    const auto [index, until_s] = entry;
    if (until_s > now_s && is_frontier(geometry_.cell_at(index))) return waits = true, false;
    if (block_ != 0) tile_of(geometry_.cell_at(index)).dirty = true;
    return true;
  });
  return waits;
}

bool FrontierTasks::tried_in_vain(std::size_t index) const {
  const auto at = given_up_.find(index);
  return at != given_up_.end() && at->second;
}

}  // namespace outrider::explorer
