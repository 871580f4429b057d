#include "explorer/task_board.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include "world/ray.hpp"

namespace outrider::explorer {
namespace {

/// Offsets within `reach` cells, nearest first; ties by row, then column.
std::vector<Cell> offsets_within(int reach) {
  std::vector<Cell> offsets;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (x * x + y * y <= reach * reach) offsets.push_back({x, y});
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](Cell a, Cell b) { return a.x * a.x + a.y * a.y < b.x * b.x + b.y * b.y; });
  return offsets;
}

}  // namespace

std::string to_string(LeftReason reason) {
  switch (reason) {
    case LeftReason::kUnreachable: return "unreachable";
    case LeftReason::kTooSmall: return "too small";
    case LeftReason::kNotObservable: return "not observable";
  }
  return "";
}

TaskBoard::TaskBoard(const RobotSpec& spec, const GridGeometry& geometry)
    : spec_(spec), geometry_(geometry), footprint_(spec.range, geometry.resolution) {
  const double edge = spec.range + geometry.resolution;
  const auto blocks = [&](int cells) { return static_cast<int>(cells * geometry.resolution / edge) + 1; };
  revisions_ = Grid<std::uint64_t>({edge, geometry.origin, blocks(geometry.width), blocks(geometry.height)});
  const double stand_off = std::min(spec.range, spec.radius + 2.0 * geometry.resolution);
  near_ = offsets_within(static_cast<int>(stand_off / geometry.resolution));
}

bool TaskBoard::too_small(const decision::FrontierCluster& cluster) const {
  return static_cast<double>(cluster.size()) * geometry_.resolution < spec_.radius;
}

std::optional<Cell> TaskBoard::stand_for(const OccupancyGrid& map, Cell task) const {
  for (const Cell offset : near_) {
    const Cell c{task.x + offset.x, task.y + offset.y};
    if (geometry_.contains(c) && field_.reached(c) && line_of_sight(map, c, task)) return c;
  }
  return std::nullopt;
}

std::vector<Cell> TaskBoard::representatives(const decision::Passability& passable,
                                             const decision::Frontiers& frontiers, double spacing) const {
  const int block = std::max(1, static_cast<int>(spacing / geometry_.resolution));
  std::vector<Cell> tasks;
  struct Candidate {
    int by, bx;
    bool blocked;
    Cell cell;
  };
  std::vector<Candidate> members;
  for (const auto& cluster : frontiers.clusters) {
    if (too_small(cluster)) continue;
    members.clear();
    for (std::uint32_t k = cluster.begin; k < cluster.end; ++k) {
      const Cell c = geometry_.cell_at(frontiers.cells[k]);
      if (given_up(c)) continue;
      if (block == 1) tasks.push_back(c);
      else members.push_back({c.y / block, c.x / block, !passable.passable(c), c});
    }
    // One task a block: its first cell that a robot can stand on, else its first cell.
    std::stable_sort(members.begin(), members.end(), [](const Candidate& a, const Candidate& b) {
      return std::tie(a.by, a.bx, a.blocked) < std::tie(b.by, b.bx, b.blocked);
    });
    for (std::size_t k = 0; k < members.size(); ++k)
      if (k == 0 || members[k].by != members[k - 1].by || members[k].bx != members[k - 1].bx)
        tasks.push_back(members[k].cell);
  }
  return tasks;
}

std::vector<BidEntry> TaskBoard::entries(const OccupancyGrid& map, const decision::Passability& passable, Cell at,
                                         const TaskGrain& grain) {
  const auto& frontiers = extractor_.extract(map);
  const Cell source[] = {at};
  field_.compute(passable.mask(), source);
  field_at_ = at;
  double spacing = grain.spacing;
  std::vector<Cell> tasks = representatives(passable, frontiers, spacing);
  while (tasks.size() > grain.most) {
    spacing = std::max(2.0 * geometry_.resolution, 2.0 * spacing);
    tasks = representatives(passable, frontiers, spacing);
  }
  std::vector<BidEntry> entries;
  for (const Cell task : tasks) {
    const auto stand = stand_for(map, task);
    if (!stand) continue;
    entries.push_back({task, *stand, grain.gains ? static_cast<float>(gain_at(map, *stand, grain.whole_footprint)) : 0.0F,
                       static_cast<float>(field_.metres(*stand))});
  }
  std::sort(entries.begin(), entries.end(), [](const BidEntry& a, const BidEntry& b) {
    return std::tie(a.task.y, a.task.x) < std::tie(b.task.y, b.task.x);
  });
  return entries;
}

void TaskBoard::give_up(Cell task, Cell stand, double spacing, const OccupancyGrid& map) {
  const int reach = static_cast<int>(spacing / 2.0 / geometry_.resolution);
  for (int y = task.y - reach; y <= task.y + reach; ++y)
    for (int x = task.x - reach; x <= task.x + reach; ++x)
      if (map.contains({x, y}) && decision::is_frontier(map, {x, y})) given_up_[{y, x}] |= stand == task;
}

void TaskBoard::note_changes(std::span<const std::uint32_t> changed) {
  ++revision_;
  for (const std::uint32_t i : changed)
    revisions_[revisions_.geometry().cell_of(geometry_.center(geometry_.cell_at(i)))] = revision_;
}

/// The footprint reaches one block far at most: the gain still holds when none of the nine blocks around has changed.
double TaskBoard::gain_at(const OccupancyGrid& map, Cell stand, bool whole) {
  const Cell block = revisions_.geometry().cell_of(geometry_.center(stand));
  std::uint64_t newest = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx)
      if (const Cell b{block.x + dx, block.y + dy}; revisions_.contains(b)) newest = std::max(newest, revisions_[b]);
  auto [entry, fresh] = gains_.try_emplace(geometry_.index(stand));
  if (fresh || entry->second.revision < newest) 
    entry->second = {revision_, whole ? footprint_.area(map, stand) : footprint_.unseen_area(map, stand)};
  return entry->second.area;
}

std::vector<Cell> TaskBoard::path_to(const Grid<std::uint8_t>& passable, Cell at, Cell stand) {
  std::vector<Cell> path;
  if (field_at_ == at && field_.reached(stand)) path = field_.path(stand);
  const auto blocked = [&](Cell c) { return !passable[c]; };
  if (path.empty() || std::any_of(path.begin(), path.end() - 1, blocked)) {
    const Cell source[] = {at};
    field_.compute(passable, source);
    field_at_ = at;
    path = field_.path(stand);
  }
  std::reverse(path.begin(), path.end());
  return path;
}

std::vector<Left> TaskBoard::left(const OccupancyGrid& map) {
  const auto& frontiers = extractor_.extract(map);
  std::vector<Left> result;
  for (const auto& cluster : frontiers.clusters) {
    std::set<std::uint32_t> unknown;
    bool tried = false;
    for (std::uint32_t k = cluster.begin; k < cluster.end; ++k) {
      const Cell c = geometry_.cell_at(frontiers.cells[k]);
      if (const auto at = given_up_.find({c.y, c.x}); at != given_up_.end()) tried = tried || at->second;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const Cell n{c.x + dx, c.y + dy};
          if (geometry_.contains(n) && map[n] == CellState::kUnknown)
            unknown.insert(static_cast<std::uint32_t>(geometry_.index(n)));
        }
    }
    const LeftReason why = tried ? LeftReason::kNotObservable
                           : too_small(cluster) ? LeftReason::kTooSmall : LeftReason::kUnreachable;
    result.push_back({cluster.centroid, static_cast<double>(unknown.size()) * geometry_.cell_area(), why});
  }
  return result;
}

}  // namespace outrider::explorer
