#pragma once
// Internal to the room: the inner loop of Dial's bucket queue (Dial 1969), shared by the distance fields.

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "decision/distance_field.hpp"

namespace outrider::decision::dial {

// A level is 0 for a blocked cell (nothing is smaller, so "shorter than known" is the obstacle test too), an offset plus
// the distance for a reached cell, and a greater number for any other. One blocked cell all around spares the border test.
constexpr std::uint32_t kBlocked = 0;
template <class D>
constexpr D kFar = std::numeric_limits<D>::max();

using BucketRing = std::array<std::vector<std::uint32_t>, 8>;
constexpr std::size_t kRingSize = std::tuple_size_v<BucketRing>;

constexpr std::uint32_t kDiagonal = 7;  // beside an edge of 5
constexpr std::uint32_t edge_of(Steps steps) { return steps == Steps::kOctile ? 5 : 1; }

constexpr std::array<Cell, 8> kDirections{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

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
inline std::uint32_t* make_room(std::vector<std::uint32_t>& bucket, std::size_t size, std::size_t more) {
  if (bucket.size() < size + more + 1) bucket.resize(2 * (size + more + 1));
  return bucket.data() + size;
}

/// The shortest path from `from`, a reached cell, down to a cell of level `source`, both included. `level(cell)` is
/// kBlocked where no way leads and greater than that of any reached cell where none was found. Among equally short ways
/// it goes on straight, then prefers the earlier direction of kDirections.
template <class Level>
std::vector<Cell> downhill_path(Cell from, std::uint32_t source, Steps steps, Level&& level) {
  std::vector<Cell> cells{from};
  Cell at = from, heading{0, 0};
  const auto leads_down = [&](Cell d) {
    const bool is_diagonal = d.x != 0 && d.y != 0;
    const Cell to{at.x + d.x, at.y + d.y};
    if (is_diagonal &&
        (steps == Steps::kOrthogonal || level({to.x, at.y}) == kBlocked || level({at.x, to.y}) == kBlocked))
      return false;
    const std::uint32_t next = level(to);
    return next != kBlocked && next < level(at) && next + (is_diagonal ? kDiagonal : edge_of(steps)) == level(at);
  };
  while (level(at) != source) {
    if (heading == Cell{0, 0} || !leads_down(heading)) {
      const auto found = std::find_if(kDirections.begin(), kDirections.end(), leads_down);
      assert(found != kDirections.end());
      heading = *found;
    }
    at = {at.x + heading.x, at.y + heading.y};
    cells.push_back(at);
  }
  return cells;
}

}  // namespace outrider::decision::dial
