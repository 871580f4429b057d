#include "explorer/task_board.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

#include "decision/frontiers.hpp"
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

/// The entries of a list, and which bid is good enough for it.
class TaskBoard::Shortlist {
 public:
  explicit Shortlist(const TaskGrain& grain) : grain_(grain) {}

  bool bounded() const { return static_cast<bool>(grain_.most_bid); }
  double most_bid(const BidEntry& entry) const { return bounded() ? grain_.most_bid(entry) : 0.0; }
  /// May a bid of at most `most_bid` be among the best?
  bool matters(double most_bid) const {
    return !bounded() || least_bids_.size() < grain_.keep || most_bid >= least_bids_.front();
  }
  bool full() const { return entries_.size() >= grain_.most; }

  void add(const BidEntry& entry) {
    entries_.push_back(entry);
    if (!bounded()) return;
    least_bids_.push_back(grain_.least_bid(entry));
    std::push_heap(least_bids_.begin(), least_bids_.end(), std::greater<>());
    if (least_bids_.size() <= grain_.keep) return;
    std::pop_heap(least_bids_.begin(), least_bids_.end(), std::greater<>());
    least_bids_.pop_back();
  }

  std::vector<BidEntry> take() {
    std::erase_if(entries_, [&](const BidEntry& e) { return !matters(most_bid(e)); });
    const auto row_major = [](const BidEntry& a, const BidEntry& b) {
      return std::tie(a.task.y, a.task.x) < std::tie(b.task.y, b.task.x);
    };
    std::sort(entries_.begin(), entries_.end(), row_major);
    if (entries_.size() > grain_.most) {
      std::stable_sort(entries_.begin(), entries_.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
      entries_.resize(grain_.most);
      std::sort(entries_.begin(), entries_.end(), row_major);
    }
    return std::move(entries_);
  }

 private:
  const TaskGrain& grain_;
  std::vector<BidEntry> entries_;
  std::vector<double> least_bids_;  // the `keep` best of the entries, a heap with the least in front
};

TaskBoard::TaskBoard(const RobotSpec& spec, const GridGeometry& geometry)
    : spec_(spec), geometry_(geometry), tasks_(spec, geometry), field_(geometry) {
  const double stand_off = std::min(spec.range, spec.radius + 2.0 * geometry.resolution);
  near_ = offsets_within(static_cast<int>(stand_off / geometry.resolution));
}

void TaskBoard::note_changes(const OccupancyGrid& map, std::span<const std::uint32_t> changed,
                             const decision::Passability& passable, std::span<const std::uint32_t> mask_changed) {
  tasks_.update(map, changed, mask_changed);
  if (mask_changed.empty()) return;
  field_.update(passable.mask(), mask_changed);
  search_at_.reset();
}

void TaskBoard::search_from(Cell at) {
  if (search_at_ == at) return;
  field_.begin(at);
  search_at_ = at;
}

/// The nearest good cell around a task from which it can be seen.
template <class Good>
std::optional<Cell> TaskBoard::stand_for(const OccupancyGrid& map, Cell task, Good&& good) const {
  for (const Cell offset : near_) {
    const Cell c{task.x + offset.x, task.y + offset.y};
    if (geometry_.contains(c) && good(c) && (c == task || line_of_sight(map, c, task))) return c;
  }
  return std::nullopt;
}

/// The tasks whose stands are farther than `beyond` [m] and not farther than `reach`. A task's stand is the nearest cell
/// where the robot fits. At the end of the search, those that cannot be reached there get another one.
std::vector<TaskBoard::Offer> TaskBoard::offers(const OccupancyGrid& map, const decision::Passability& passable, Cell at,
                                                double beyond, double reach, bool gains) {
  std::vector<Offer> offers;
  const double stand_off = spec_.radius + 3.0 * geometry_.resolution;
  const double farthest = 1.02 * reach + stand_off;  // octile lengths are up to 1 % short
  const double farthest2 = farthest * farthest / geometry_.cell_area();
  tasks_.for_near(passable, at, farthest, [&](FrontierTask& task) {
    const double dx = task.cell.x - at.x, dy = task.cell.y - at.y;
    if (dx * dx + dy * dy > farthest2) return;
    auto stand = stand_for(map, task.cell, [&](Cell c) { return passable.passable(c); });
    double distance = stand ? field_.metres(*stand) : decision::ReachField::kNoLimit;
    if (distance <= beyond || (distance > reach && !field_.exhausted())) return;
    if (distance == decision::ReachField::kNoLimit) {
      stand = stand_for(map, task.cell, [&](Cell c) { return field_.reached(c); });
      if (!stand) return;
      distance = field_.metres(*stand);
    }
    const double gain = gains ? tasks_.most_gain(task, *stand) : 0.0;
    offers.push_back({&task, {task.cell, *stand, static_cast<float>(gain), static_cast<float>(distance)}, 0.0});
  });
  return offers;
}

/// How far to search after all within `reach` [m] is on the list: as far as a task may matter; `reach` when none does.
double TaskBoard::next_reach(const Shortlist& list, double reach, bool gains) const {
  constexpr double kFarther = 1.6, kClose = 0.03;
  const auto matters = [&](double distance) {
    const auto gain = static_cast<float>(gains ? tasks_.most_gain() : 0.0);
    return list.matters(list.most_bid({{}, {}, gain, static_cast<float>(distance)}));
  };
  double near = reach, far = kFarther * reach;
  if (!list.bounded() || matters(far)) return far;
  if (!matters(near)) return near;
  while (far > near * (1.0 + kClose)) {
    const double middle = 0.5 * (near + far);
    (matters(middle) ? near : far) = middle;
  }
  return far;
}

std::vector<BidEntry> TaskBoard::entries(const OccupancyGrid& map, const decision::Passability& passable, Cell at,
                                         const TaskGrain& grain) {
  tasks_.set_spacing(grain.spacing);
  search_from(at);
  Shortlist list(grain);
  double beyond = -1.0, reach = spec_.range + geometry_.resolution;
  for (;;) {
    field_.extend(reach);
    if (field_.exhausted()) reach = decision::ReachField::kNoLimit;
    std::vector<Offer> ring = offers(map, passable, at, beyond, reach, grain.gains);
    for (Offer& offer : ring) offer.most_bid = list.most_bid(offer.entry);
    std::stable_sort(ring.begin(), ring.end(), [](const Offer& a, const Offer& b) { return a.most_bid > b.most_bid; });
    for (Offer& offer : ring) {
      if (!list.matters(offer.most_bid)) break;
      if (grain.gains || tasks_.least_gain() > 0.0) {
        if (tasks_.is_left_over(*offer.task, offer.entry.stand)) continue;
        const double gain = tasks_.gain(map, *offer.task, offer.entry.stand, grain.whole_footprint);
        if (tasks_.is_left_over(*offer.task, offer.entry.stand)) continue;
        if (grain.gains) offer.entry.gain = static_cast<float>(gain);
      }
      list.add(offer.entry);
    }
    beyond = reach;
    reach = list.full() || field_.exhausted() ? beyond : next_reach(list, beyond, grain.gains);
    if (reach == beyond) break;
  }
  return list.take();
}

std::vector<Cell> TaskBoard::path_to(Cell at, Cell stand) {
  search_from(at);
  for (double reach = distance(geometry_.center(at), geometry_.center(stand));
       !field_.reached(stand) && !field_.exhausted(); reach += reach)
    field_.extend(reach);
  std::vector<Cell> path = field_.path(stand);
  std::reverse(path.begin(), path.end());
  return path;
}

std::vector<Left> TaskBoard::left(const OccupancyGrid& map) const {
  decision::FrontierExtractor extractor;
  const auto& frontiers = extractor.extract(map);
  std::vector<Left> result;
  for (const auto& cluster : frontiers.clusters) {
    std::set<std::uint32_t> unknown;
    bool tried = false;
    for (std::uint32_t k = cluster.begin; k < cluster.end; ++k) {
      const Cell c = geometry_.cell_at(frontiers.cells[k]);
      tried = tried || tasks_.tried_in_vain(frontiers.cells[k]);
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const Cell n{c.x + dx, c.y + dy};
          if (geometry_.contains(n) && map[n] == CellState::kUnknown)
            unknown.insert(static_cast<std::uint32_t>(geometry_.index(n)));
        }
    }
    const double unknown_m2 = static_cast<double>(unknown.size()) * geometry_.cell_area();
    const bool too_small = static_cast<double>(cluster.size()) * geometry_.resolution < spec_.radius ||
                           unknown_m2 < tasks_.least_gain();
    const LeftReason why = tried ? LeftReason::kNotObservable
                           : too_small ? LeftReason::kTooSmall : LeftReason::kUnreachable;
    result.push_back({cluster.centroid, unknown_m2, why});
  }
  return result;
}

}  // namespace outrider::explorer
