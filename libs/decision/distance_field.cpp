#include "decision/distance_field.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

namespace outrider::decision {
namespace {

// A level is 0 for a blocked cell (nothing is smaller, so "shorter than known" is the obstacle test too), 1 + distance
// for a reached cell, and the largest number for any other. One blocked cell all around spares the border test.
constexpr std::uint32_t kBlocked = 0, kSource = 1;
template <class D>
constexpr D kFar = std::numeric_limits<D>::max();

using BucketRing = std::array<std::vector<std::uint32_t>, 8>;
constexpr std::size_t kRingSize = std::tuple_size_v<BucketRing>;

constexpr std::uint32_t kDiagonal = 7;  // beside an edge of 5
constexpr std::uint32_t edge_of(Steps steps) { return steps == Steps::kOctile ? 5 : 1; }

constexpr std::array<Cell, 8> kDirections{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

template <class D>
void load_mask(const Grid<std::uint8_t>& mask, std::vector<D>& levels) {
  const auto width = static_cast<std::size_t>(mask.width()), height = static_cast<std::size_t>(mask.height());
  levels.resize((width + 2) * (height + 2));
  std::fill_n(levels.begin(), width + 2, D{kBlocked});
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* from = mask.data().data() + y * width;
    D* to = levels.data() + (y + 1) * (width + 2);
    to[0] = to[width + 1] = D{kBlocked};
    for (std::size_t x = 0; x < width; ++x) to[x + 1] = from[x] != 0 ? kFar<D> : D{kBlocked};
  }
  std::fill_n(levels.end() - static_cast<std::ptrdiff_t>(width + 2), width + 2, D{kBlocked});
}

/// Lowers levels and collects the cells that became nearer.
template <class D>
struct Lowering {
  D* levels;
  std::uint32_t* end;  ///< of the bucket that collects them

  void by_edge(std::size_t cell, std::uint32_t level) {
    if (level >= levels[cell]) return;
    levels[cell] = static_cast<D>(level);
    *end++ = static_cast<std::uint32_t>(cell);
  }
  /// Writes before it knows whether the cell counts: diagonals are hard to predict, and an addition costs less than a
  /// wrong guess. (Edges are easier to predict: measured, branches win there.)
  void by_diagonal(std::size_t cell, std::uint32_t level, bool allowed) {
    const std::uint32_t known = levels[cell];
    const bool shorter = (level < known) & allowed;
    levels[cell] = static_cast<D>(shorter ? level : known);
    *end = static_cast<std::uint32_t>(cell);
    end += shorter;
  }
};

/// Lowers the neighbours of all cells of `now` that still have `level`.
template <class D, Steps kSteps>
void expand(std::span<const std::uint32_t> now, std::size_t stride, std::uint32_t level, std::uint32_t edge_level,
            std::uint32_t diagonal_level, Lowering<D>& edges, Lowering<D>& diagonals) {
  const D* levels = edges.levels;
  for (const std::size_t c : now) {
    // Was a shorter way found since? Not where all steps are equal.
    if (kSteps == Steps::kOctile && levels[c] != level) continue;
    const std::size_t up = c + stride, down = c - stride;
    const bool e = levels[c + 1] != kBlocked, w = levels[c - 1] != kBlocked;
    const bool n = levels[up] != kBlocked, s = levels[down] != kBlocked;
    edges.by_edge(down, edge_level);
    edges.by_edge(c - 1, edge_level);
    edges.by_edge(c + 1, edge_level);
    edges.by_edge(up, edge_level);
    if constexpr (kSteps == Steps::kOctile) {
      diagonals.by_diagonal(down - 1, diagonal_level, s & w);
      diagonals.by_diagonal(down + 1, diagonal_level, s & e);
      diagonals.by_diagonal(up - 1, diagonal_level, n & w);
      diagonals.by_diagonal(up + 1, diagonal_level, n & e);
    }
  }
}

/// Room for `more` cells at the end of a bucket. One more than can come, as the last write may not count.
std::uint32_t* make_room(std::vector<std::uint32_t>& bucket, std::size_t size, std::size_t more) {
  if (bucket.size() < size + more + 1) bucket.resize(2 * (size + more + 1));
  return bucket.data() + size;
}

/// Lowers `levels` from the sources, `count` cells in bucket 0, to their distances as far as `limit`. False when D is
/// too narrow for them.
template <class D, Steps kSteps>
bool flood(std::vector<D>& levels, std::size_t stride, std::uint32_t limit, BucketRing& buckets, std::size_t count) {
  constexpr std::uint32_t kEdge = edge_of(kSteps);
  std::array<std::size_t, kRingSize> sizes{count};
  std::size_t empty = 0;  // buckets in a row
  for (std::uint32_t d = 0; empty < kRingSize; ++d) {
    const std::size_t size = std::exchange(sizes[d % kRingSize], 0);
    empty = size == 0 ? empty + 1 : 0;
    if (size == 0) continue;
    if (d < limit && d >= kFar<D> - kDiagonal - kSource) return false;
    const std::size_t at_edge = (d + kEdge) % kRingSize, at_diagonal = (d + kDiagonal) % kRingSize;
    Lowering<D> edges{levels.data(), make_room(buckets[at_edge], sizes[at_edge], 4 * size)};
    Lowering<D> diagonals{levels.data(), make_room(buckets[at_diagonal], sizes[at_diagonal], 4 * size)};
    // A step beyond the limit leads to kFar, which never is shorter.
    expand<D, kSteps>({buckets[d % kRingSize].data(), size}, stride, d + kSource,
                      d + kEdge <= limit ? d + kEdge + kSource : kFar<D>,
                      d + kDiagonal <= limit ? d + kDiagonal + kSource : kFar<D>, edges, diagonals);
    sizes[at_edge] = static_cast<std::size_t>(edges.end - buckets[at_edge].data());
    sizes[at_diagonal] = static_cast<std::size_t>(diagonals.end - buckets[at_diagonal].data());
  }
  return true;
}

}  // namespace

template <class D>
bool DistanceField::fill(std::vector<D>& levels, const Grid<std::uint8_t>& mask, std::span<const Cell> sources,
                         std::uint32_t limit) {
  load_mask(mask, levels);
  make_room(buckets_[0], 0, sources.size());
  std::size_t count = 0;
  for (const Cell source : sources) {
    if (!geometry_.contains(source) || levels[padded_index(source)] == kSource) continue;
    levels[padded_index(source)] = D{kSource};
    buckets_[0][count++] = static_cast<std::uint32_t>(padded_index(source));
  }
  const auto stride = static_cast<std::size_t>(geometry_.width) + 2;
  return steps_ == Steps::kOctile ? flood<D, Steps::kOctile>(levels, stride, limit, buckets_, count)
                                  : flood<D, Steps::kOrthogonal>(levels, stride, limit, buckets_, count);
}

void DistanceField::compute(const Grid<std::uint8_t>& mask, std::span<const Cell> sources, double max_m, Steps steps) {
  assert(max_m >= 0.0);
  geometry_ = mask.geometry();
  steps_ = steps;
  constexpr std::uint32_t kLongest = kFar<std::uint32_t> - 64;
  const double limit = std::floor(max_m / geometry_.resolution * edge_of(steps) * (1.0 + 1e-12));
  const auto whole = limit < kLongest ? static_cast<std::uint32_t>(limit) : kLongest;
  narrow_ = fill(levels16_, mask, sources, whole);
  if (!narrow_) fill(levels32_, mask, sources, whole);
}

std::uint32_t DistanceField::level(Cell c) const {
  if (!geometry_.contains(c)) return kBlocked;
  const std::size_t i = padded_index(c);
  if (!narrow_) return levels32_[i];
  return levels16_[i] == kFar<std::uint16_t> ? kFar<std::uint32_t> : levels16_[i];
}

bool DistanceField::reached(Cell c) const {
  const std::uint32_t l = level(c);
  return l != kBlocked && l != kFar<std::uint32_t>;
}

double DistanceField::metres(Cell c) const {
  if (!reached(c)) return kNoLimit;
  return static_cast<double>(level(c) - kSource) * geometry_.resolution / edge_of(steps_);
}

std::vector<Cell> DistanceField::path(Cell from) const {
  std::vector<Cell> cells;
  if (!reached(from)) return cells;
  Cell at = from, heading{0, 0};
  cells.push_back(at);
  while (level(at) != kSource) {
    heading = downhill(at, heading);
    at = {at.x + heading.x, at.y + heading.y};
    cells.push_back(at);
  }
  return cells;
}

/// A direction in which a step from `at` is the beginning of a shortest path; `heading` when it is one.
Cell DistanceField::downhill(Cell at, Cell heading) const {
  const auto leads_down = [&](Cell d) {
    const bool is_diagonal = d.x != 0 && d.y != 0;
    const Cell to{at.x + d.x, at.y + d.y};
    if (is_diagonal &&
        (steps_ == Steps::kOrthogonal || level({to.x, at.y}) == kBlocked || level({at.x, to.y}) == kBlocked))
      return false;
    return reached(to) && level(to) + (is_diagonal ? kDiagonal : edge_of(steps_)) == level(at);
  };
  if (heading != Cell{0, 0} && leads_down(heading)) return heading;
  const auto found = std::find_if(kDirections.begin(), kDirections.end(), leads_down);
  assert(found != kDirections.end());
  return *found;
}

}  // namespace outrider::decision
