#include "explorer/task_board.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>
#include <utility>

#include "decision/frontiers.hpp"
#include "world/ray.hpp"

namespace outrider::explorer {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

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
  /// By which candidates are looked at; what a bid for it is at most, when that is known, else the nearest come first.
  double rank(const BidEntry& entry) const {
    return bounded() ? grain_.most_bid(entry) : -static_cast<double>(entry.distance);
  }
  /// May something of this rank be among the best?
  bool matters(double rank) const {
    return !bounded() || least_bids_.size() < grain_.keep || rank >= least_bids_.front();
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
    std::erase_if(entries_, [&](const BidEntry& e) { return !matters(rank(e)); });
    const auto row_major = [](const BidEntry& a, const BidEntry& b) {
      return std::tie(a.task.y, a.task.x) < std::tie(b.task.y, b.task.x);
    };
    std::sort(entries_.begin(), entries_.end(), row_major);
    return std::move(entries_);
  }

 private:
  const TaskGrain& grain_;
  std::vector<BidEntry> entries_;
  std::vector<double> least_bids_;  // the `keep` best of the entries, a heap with the least in front
};

TaskBoard::TaskBoard(const RobotSpec& spec, const OccupancyGrid& map)
    : spec_(spec), map_(map), geometry_(map.geometry()), tasks_(spec, map), field_(map.geometry()) {
  stand_off_ = std::min(spec.range, spec.radius + 2.0 * geometry_.resolution);
  near_ = offsets_within(static_cast<int>(stand_off_ / geometry_.resolution));
}

void TaskBoard::note_changes(std::span<const std::uint32_t> changed, const decision::Passability& passable,
                             std::span<const std::uint32_t> mask_changed) {
  tasks_.update(changed, mask_changed);
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
std::optional<Cell> TaskBoard::stand_for(Cell task, Good&& good) const {
  for (const Cell offset : near_) {
    const Cell c{task.x + offset.x, task.y + offset.y};
    if (geometry_.contains(c) && good(c) && (c == task || line_of_sight(map_, c, task))) return c;
  }
  return std::nullopt;
}

/// One look for tasks, best first: the candidate that may be worth most is looked at more closely, its gain or its way,
/// until both are known of all that may matter. The field is searched no farther than such a candidate is.
class TaskBoard::Search {
 public:
  Search(TaskBoard& board, const decision::Passability& passable, Cell at, const TaskGrain& grain)
      : board_(board), passable_(passable), at_(at), grain_(grain), list_(grain) {}

  std::vector<BidEntry> run() {
    list_farther();
    while (!list_.full()) {
      const double unlisted = unlisted_rank();
      if (open_.empty() || open_.front().rank <= unlisted) {
        if (all_listed() || !list_.matters(unlisted)) break;
        list_farther();
        continue;
      }
      if (!list_.matters(open_.front().rank)) break;
      std::pop_heap(open_.begin(), open_.end());
      const std::size_t best = open_.back().candidate;
      open_.pop_back();
      look_closer(candidates_[best], best);
    }
    return list_.take();
  }

 private:
  struct Candidate {
    FrontierTask* task;
    BidEntry entry;  // the gain is at most this, the distance at least
    bool placed = false, weighed = false, reached = false;  // stand, gain and distance are known
  };
  struct Open {
    double rank;  // of the candidate at most
    std::size_t candidate;
    bool operator<(const Open& other) const {
      return rank != other.rank ? rank < other.rank : candidate > other.candidate;
    }
  };

  bool all_listed() const { return listed_m_ >= board_.geometry_.resolution * std::max(board_.geometry_.width, board_.geometry_.height); }
  double most_gain(double gain) const { return grain_.gains ? gain : 0.0; }

  /// Of the tasks outside the square that has been listed.
  double unlisted_rank() const {
    if (all_listed()) return -kNever;
    const double distance = std::max(0.0, listed_m_ - board_.stand_off_);
    return list_.rank({{}, {}, static_cast<float>(most_gain(board_.tasks_.most_gain())), static_cast<float>(distance)});
  }

  void list_farther() {
    constexpr double kFarther = 1.6;
    const double beyond = std::exchange(listed_m_, listed_m_ < 0.0 ? board_.spec_.range : kFarther * listed_m_);
    board_.tasks_.for_near(passable_, at_, beyond, listed_m_, [&](FrontierTask& task) {
      Candidate c{&task, {task.cell, task.cell}};
      c.placed = passable_.passable(task.cell);
      c.entry.distance = least_way(task.cell, c.placed ? 0.0 : board_.stand_off_);
      c.entry.gain = static_cast<float>(
          most_gain(c.placed ? board_.tasks_.most_gain(task, task.cell) : board_.tasks_.most_gain()));
      if (!list_.matters(list_.rank(c.entry))) return;
      candidates_.push_back(c);
      push(candidates_.size() - 1);
    });
  }

  /// No way to a place within `off` [m] of `c` is shorter.
  float least_way(Cell c, double off) const {
    const int dx = std::abs(c.x - at_.x), dy = std::abs(c.y - at_.y);
    const int fifths = 5 * std::max(dx, dy) + 2 * std::min(dx, dy);
    return static_cast<float>(std::max(0.0, fifths * board_.geometry_.resolution / 5.0 - off));
  }

  void push(std::size_t candidate) {
    open_.push_back({list_.rank(candidates_[candidate].entry), candidate});
    std::push_heap(open_.begin(), open_.end());
  }

  void look_closer(Candidate& c, std::size_t index) {
    const bool gain_counts = list_.bounded() && grain_.gains;
    if (!c.placed) {
      if (find_place(c)) push(index);
    } else if (!c.weighed && (gain_counts || c.reached)) {
      weigh(c);
      push(index);
    } else if (!c.reached) {
      if (reach(c)) push(index);
    } else if (!board_.tasks_.is_left_over(*c.task, c.entry.stand)) {
      list_.add(c.entry);
    }
  }

  bool find_place(Candidate& c) {
    auto stand = board_.stand_for(c.entry.task, [&](Cell s) { return passable_.passable(s); });
    if (!stand) stand = board_.stand_for(c.entry.task, [&](Cell s) { return s == at_; });
    if (stand) place(c, *stand);
    return stand.has_value();
  }

  void place(Candidate& c, Cell stand) {
    c.entry.stand = stand;
    c.entry.distance = least_way(stand, 0.0);
    c.entry.gain = static_cast<float>(most_gain(board_.tasks_.most_gain(*c.task, stand)));
    c.placed = true;
    c.weighed = c.reached = false;
  }

  void weigh(Candidate& c) const {
    FrontierTasks& tasks = board_.tasks_;
    c.weighed = true;
    if (!grain_.gains && tasks.least_gain() == 0.0) return;
    const bool left_over = tasks.is_left_over(*c.task, c.entry.stand);  // that it stays
    c.entry.gain = static_cast<float>(
        most_gain(left_over ? c.task->gain : tasks.gain(*c.task, c.entry.stand, grain_.whole_footprint)));
  }

  /// False when there is no way to it.
  bool reach(Candidate& c) {
    constexpr double kFarther = 1.05;
    decision::ReachField& field = board_.field_;
    const double search_m = kFarther * c.entry.distance + board_.geometry_.resolution;
    field.extend(search_m);
    c.reached = field.reached(c.entry.stand);
    c.entry.distance = static_cast<float>(c.reached ? field.metres(c.entry.stand) : search_m);
    if (c.reached || !field.exhausted()) return true;
    // All is known that can be reached, and the task's nearest stand is not: is another?
    const auto stand = board_.stand_for(c.entry.task, [&](Cell s) { return field.reached(s); });
    if (stand) place(c, *stand);
    return stand.has_value();
  }

  TaskBoard& board_;
  const decision::Passability& passable_;
  Cell at_;
  const TaskGrain& grain_;
  Shortlist list_;
  std::vector<Candidate> candidates_;
  std::vector<Open> open_;       // a heap, the greatest rank in front
  double listed_m_ = -1.0;       // half edge of the square around `at` whose tasks are candidates or done
};

std::vector<BidEntry> TaskBoard::entries(const decision::Passability& passable, Cell at, const TaskGrain& grain) {
  tasks_.set_spacing(grain.spacing);
  search_from(at);
  return Search(*this, passable, at, grain).run();
}

void TaskBoard::give_up_from(const decision::Passability& passable, Cell stand) {
  search_from(stand);
  field_.extend(decision::ReachField::kNoLimit);
  for (const Cell offset : near_) {
    const Cell c{stand.x + offset.x, stand.y + offset.y};
    if (!geometry_.contains(c) || !decision::is_frontier(map_, c)) continue;
    auto own = stand_for(c, [&](Cell s) { return passable.passable(s); });
    if (!own || !field_.reached(*own)) own = stand_for(c, [&](Cell s) { return field_.reached(s); });
    if (own == stand) tasks_.give_up(c, c == stand);
  }
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
