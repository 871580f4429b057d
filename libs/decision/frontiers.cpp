#include "decision/frontiers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace outrider::decision {
namespace {

static_assert(static_cast<int>(CellState::kUnknown) == 0, "the smallest state, so that a minimum finds it");

// The loops of these two functions are plain so that the compiler turns them into byte-wide SIMD.

/// lowest[x + 1] = smallest state of column x in three rows.
void lowest_of_columns(const std::uint8_t* __restrict below, const std::uint8_t* __restrict row,
                       const std::uint8_t* __restrict above, std::uint8_t* __restrict lowest, std::size_t width) {
  for (std::size_t x = 0; x < width; ++x) lowest[x + 1] = std::min(std::min(below[x], row[x]), above[x]);
}

/// flags[x] = 1 where a free cell of `row` has an unknown cell around it.
void flag_frontier(const std::uint8_t* __restrict row, const std::uint8_t* __restrict lowest,
                   std::uint8_t* __restrict flags, std::size_t width) {
  constexpr auto kFree = static_cast<std::uint8_t>(CellState::kFree);
  for (std::size_t x = 0; x < width; ++x) {
    const std::uint8_t around = std::min(std::min(lowest[x], lowest[x + 1]), lowest[x + 2]);
    flags[x] = static_cast<std::uint8_t>((row[x] == kFree) & (around == 0));
  }
}

constexpr std::uint64_t kAllFlags = 0x0101010101010101;

}  // namespace

bool is_frontier(const OccupancyGrid& map, Cell c) {
  if (!map.contains(c) || map[c] != CellState::kFree) return false;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const Cell n{c.x + dx, c.y + dy};
      if (map.contains(n) && map[n] == CellState::kUnknown) return true;
    }
  return false;
}

const Frontiers& FrontierExtractor::extract(const OccupancyGrid& map) {
  runs_.clear();
  result_.cells.clear();
  result_.clusters.clear();
  if (map.size() > 0) detect(map);
  number_clusters();
  describe_clusters(map.geometry());
  return result_;
}

void FrontierExtractor::detect(const OccupancyGrid& map) {
  const auto width = static_cast<std::size_t>(map.width());
  const auto* states = reinterpret_cast<const std::uint8_t*>(map.data().data());
  lowest_.assign(width + 2, static_cast<std::uint8_t>(CellState::kFree));  // the columns beside the map count as known
  flags_.assign(width + 2 * sizeof(std::uint64_t), 0);                     // zeros end the last run of a row
  std::size_t first_above = 0;
  for (int y = 0; y < map.height(); ++y) {
    const std::uint8_t* row = states + static_cast<std::size_t>(y) * width;
    const std::uint8_t* below = y > 0 ? row - width : row;
    const std::uint8_t* above = y + 1 < map.height() ? row + width : row;
    lowest_of_columns(below, row, above, lowest_.data(), width);
    flag_frontier(row, lowest_.data(), flags_.data(), width);
    const std::size_t first = runs_.size();
    collect_runs(y, map.width());
    join(first_above, first);
    first_above = first;
  }
}

void FrontierExtractor::collect_runs(int y, int width) {
  for (int x = 0; x < width;) {
    std::uint64_t eight;
    std::memcpy(&eight, flags_.data() + x, sizeof eight);
    if (eight == 0) {
      x += 8;
      continue;
    }
    const int begin = x + std::countr_zero(eight) / 8;
    // The first zero byte after `begin`, eight at a time; the row ends in zeros.
    for (x = begin;; x += 8) {
      std::memcpy(&eight, flags_.data() + x, sizeof eight);
      const std::uint64_t gaps = eight ^ kAllFlags;
      if (gaps == 0) continue;
      x += std::countr_zero(gaps) / 8;
      break;
    }
    runs_.push_back({y, begin, x, static_cast<std::uint32_t>(runs_.size())});
  }
}

/// Unites the runs from number `row` on with those of the row below, `above` <= number < `row`, that they touch.
void FrontierExtractor::join(std::size_t above, std::size_t row) {
  if (above == row || runs_[above].y + 1 != runs_.back().y) return;
  std::size_t a = above;
  for (std::size_t r = row; r < runs_.size(); ++r) {
    while (a < row && runs_[a].end < runs_[r].begin) ++a;
    for (std::size_t b = a; b < row && runs_[b].begin <= runs_[r].end; ++b) {
      const std::uint32_t root_b = root(static_cast<std::uint32_t>(b)), root_r = root(static_cast<std::uint32_t>(r));
      runs_[std::max(root_b, root_r)].parent = std::min(root_b, root_r);
    }
  }
}

std::uint32_t FrontierExtractor::root(std::uint32_t run) {
  while (runs_[run].parent != run) run = runs_[run].parent = runs_[runs_[run].parent].parent;
  return run;
}

/// Turns every run's parent into its cluster's number. Parents come before their children, and a root before all of
/// its set, so one pass in order does, and clusters are numbered by their smallest cell.
void FrontierExtractor::number_clusters() {
  sums_.clear();
  for (std::uint32_t i = 0; i < runs_.size(); ++i) {
    Run& run = runs_[i];
    if (run.parent == i) {
      run.parent = static_cast<std::uint32_t>(sums_.size());
      result_.clusters.emplace_back();
      sums_.emplace_back();
    } else {
      run.parent = runs_[run.parent].parent;
    }
    const std::int64_t n = run.end - run.begin;
    sums_[run.parent].x += n * (run.begin + run.end - 1) / 2;
    sums_[run.parent].y += n * run.y;
    result_.clusters[run.parent].end += static_cast<std::uint32_t>(n);
  }
}

void FrontierExtractor::describe_clusters(const GridGeometry& g) {
  std::uint32_t begin = 0;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    FrontierCluster& cluster = result_.clusters[i];
    const double n = cluster.end;
    sums_[i].left = static_cast<int>(sums_[i].x / cluster.end);
    const Point mean{static_cast<double>(sums_[i].x) / n, static_cast<double>(sums_[i].y) / n};
    cluster.centroid = {g.origin.x + (mean.x + 0.5) * g.resolution, g.origin.y + (mean.y + 0.5) * g.resolution};
    cluster.begin = begin;
    begin += cluster.end;
    cluster.end = cluster.begin;  // grows again as the cells are filled in
    sums_[i].best = std::numeric_limits<double>::infinity();
  }
  result_.cells.resize(begin);
  for (const Run& run : runs_) {
    FrontierCluster& cluster = result_.clusters[run.parent];
    auto index = static_cast<std::uint32_t>(g.index({run.begin, run.y}));
    for (int x = run.begin; x < run.end; ++x) result_.cells[cluster.end++] = index++;
  }
  find_medoids();
}

/// Within a run only the two cells beside the centroid's column can be nearest. Distances are compared as n times the
/// offset, which is a whole number, so that ties are ties.
void FrontierExtractor::find_medoids() {
  for (const Run& run : runs_) {
    FrontierCluster& cluster = result_.clusters[run.parent];
    Sums& sums = sums_[run.parent];
    const auto n = static_cast<std::int64_t>(cluster.size());
    for (const int column : {sums.left, sums.left + 1}) {
      const int x = std::clamp(column, run.begin, run.end - 1);
      const auto dx = static_cast<double>(n * x - sums.x), dy = static_cast<double>(n * run.y - sums.y);
      const double d = dx * dx + dy * dy;
      if (d >= sums.best) continue;
      sums.best = d;
      cluster.medoid = {x, run.y};
    }
  }
}

}  // namespace outrider::decision
