#include "decision/reach_field.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "decision/dial.hpp"
#include "world/cell_finder.hpp"

namespace outrider::decision {
namespace {

using namespace dial;

constexpr std::uint32_t kNever = kFar<std::uint32_t>;
constexpr std::uint32_t kEdge = edge_of(Steps::kOctile);

/// No path on a map of so many cells is longer.
std::uint32_t longest(std::size_t cells) { return static_cast<std::uint32_t>(kDiagonal * (cells + 2)); }

/// A search may use so many levels before it has to look after those of the searches before it; few go farther.
std::uint32_t reserve_for(std::size_t open, const GridGeometry& g) {
  return std::min(longest(open), longest(2 * static_cast<std::size_t>(g.width + g.height)));
}

}  // namespace

ReachField::ReachField(const GridGeometry& geometry)
    : geometry_(geometry),
      levels_(static_cast<std::size_t>(geometry.width + 2) * static_cast<std::size_t>(geometry.height + 2), kBlocked),
      base_(kNever - longest(geometry.size())),
      borrowed_(0) {}

void ReachField::update(const Grid<std::uint8_t>& mask, std::span<const std::uint32_t> changed) {
  CellFinder cell_at(geometry_);
  for (const std::uint32_t index : changed) {
    const std::size_t at = padded_index(cell_at(index));
    std::uint32_t& level = levels_[at];
    const bool is_borrowed = at == borrowed_;
    if (level != kBlocked && !is_borrowed) --open_;
    if (is_borrowed) borrowed_ = 0;
    level = mask[index] != 0 ? kNever : kBlocked;
    if (level != kBlocked) ++open_;
  }
  settled_ = 0;
  empty_ = kRingSize;
}

void ReachField::begin(Cell source) {
  if (borrowed_ != 0) levels_[std::exchange(borrowed_, 0)] = kBlocked;
  const std::uint32_t reserve = reserve_for(open_, geometry_);
  if (base_ <= reserve + 1) {
    for (std::uint32_t& level : levels_)
      if (level != kBlocked) level = kNever;
    base_ = kNever - longest(geometry_.size());
  }
  base_ -= reserve;
  const std::size_t at = padded_index(source);
  if (levels_[at] == kBlocked) borrowed_ = at;
  levels_[at] = base_;
  sizes_ = {1};
  make_room(buckets_[0], 0, 1)[0] = static_cast<std::uint32_t>(at);
  settled_ = next_ = 0;
  empty_ = 0;
}

void ReachField::extend(double max_m) {
  constexpr double kLongest = 4e9;
  const auto limit = static_cast<std::uint32_t>(
      std::min(kLongest, std::floor(max_m / geometry_.resolution * kEdge * (1.0 + 1e-12))));
  const auto stride = static_cast<std::size_t>(geometry_.width) + 2;
  const std::uint32_t reserve = reserve_for(open_, geometry_);
  for (; empty_ < kRingSize && next_ <= limit; ++next_) {
    if (next_ + kDiagonal == reserve)  // beyond, levels of searches before this one could be in the way
      for (std::uint32_t& level : levels_)
        if (level != kBlocked && level - base_ >= reserve) level = kNever;
    settled_ = next_;
    const std::size_t size = std::exchange(sizes_[next_ % kRingSize], 0);
    empty_ = size == 0 ? empty_ + 1 : 0;
    if (size == 0) continue;
    const std::size_t at_edge = (next_ + kEdge) % kRingSize, at_diagonal = (next_ + kDiagonal) % kRingSize;
    Lowering<std::uint32_t> edges{levels_.data(), make_room(buckets_[at_edge], sizes_[at_edge], 4 * size)};
    Lowering<std::uint32_t> diagonals{levels_.data(), make_room(buckets_[at_diagonal], sizes_[at_diagonal], 4 * size)};
    const std::uint32_t level = base_ + next_;
    expand<std::uint32_t, Steps::kOctile>({buckets_[next_ % kRingSize].data(), size}, stride, level, level + kEdge,
                                          level + kDiagonal, edges, diagonals);
    sizes_[at_edge] = static_cast<std::size_t>(edges.end - buckets_[at_edge].data());
    sizes_[at_diagonal] = static_cast<std::size_t>(diagonals.end - buckets_[at_diagonal].data());
  }
}

std::vector<Cell> ReachField::path(Cell from) const {
  if (!reached(from)) return {};
  return downhill_path(from, base_, Steps::kOctile,
                       [this](Cell c) { return geometry_.contains(c) ? level(c) : kBlocked; });
}

}  // namespace outrider::decision
