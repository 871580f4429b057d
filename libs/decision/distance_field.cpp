#include "decision/distance_field.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <utility>

#include "decision/dial.hpp"

namespace outrider::decision {
namespace {

using namespace dial;

constexpr std::uint32_t kSource = 1;  // the level of a source

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
  if (!reached(from)) return {};
  return downhill_path(from, kSource, steps_, [this](Cell c) { return level(c); });
}

}  // namespace outrider::decision
