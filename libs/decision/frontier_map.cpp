#include "decision/frontier_map.hpp"

#include <algorithm>
#include <cassert>

namespace outrider::decision {
namespace {

/// Calls visit(cell) for the neighbours of `c` that lie in the map.
template <class Visit>
void for_neighbours(const GridGeometry& g, Cell c, Visit&& visit) {
  for (int y = std::max(c.y - 1, 0); y <= std::min(c.y + 1, g.height - 1); ++y)
    for (int x = std::max(c.x - 1, 0); x <= std::min(c.x + 1, g.width - 1); ++x)
      if (x != c.x || y != c.y) visit(Cell{x, y});
}

}  // namespace

FrontierMap::FrontierMap(const GridGeometry& geometry) : cells_(geometry, 8) {
  const auto count = [&](Cell c) {
    cells_[c] = 0;
    for_neighbours(geometry, c, [&](Cell) { ++cells_[c]; });
  };
  for (int x = 0; x < geometry.width; ++x)
    for (const int y : {0, geometry.height - 1}) count({x, y});
  for (int y = 0; y < geometry.height; ++y)
    for (const int x : {0, geometry.width - 1}) count({x, y});
}

std::span<const std::uint32_t> FrontierMap::update(const OccupancyGrid& map, std::span<const std::uint32_t> changed) {
  assert(map.geometry() == cells_.geometry());
  flipped_.clear();
  for (const std::uint32_t index : changed) {
    const std::uint8_t cell = cells_[index];
    const auto before = static_cast<CellState>((cell & kState) >> kStateShift), now = map[index];
    if (before == now) continue;
    store(index, static_cast<std::uint8_t>((cell & kUnknownNeighbours) | static_cast<int>(now) << kStateShift));
    if ((before == CellState::kUnknown) == (now == CellState::kUnknown)) continue;
    const int more = now == CellState::kUnknown ? 1 : -1;
    for_neighbours(map.geometry(), map.geometry().cell_at(index), [&](Cell n) {
      const std::size_t i = map.geometry().index(n);
      store(i, static_cast<std::uint8_t>(cells_[i] + more));
    });
  }
  return flipped_;
}

void FrontierMap::store(std::size_t index, std::uint8_t cell) {
  constexpr auto kFree = static_cast<std::uint8_t>(static_cast<int>(CellState::kFree) << kStateShift);
  const bool was = is_frontier(index), is = (cell & kState) == kFree && (cell & kUnknownNeighbours) != 0;
  cells_[index] = static_cast<std::uint8_t>((cell & (kUnknownNeighbours | kState)) | (is ? kFrontier : 0));
  if (was == is) return;
  count_ += is ? 1U : static_cast<std::size_t>(-1);
  flipped_.push_back(static_cast<std::uint32_t>(index));
}

bool FrontierMap::has_company(Cell c, std::size_t least) const {
  std::vector<Cell> found{c};
  for (std::size_t k = 0; k < found.size() && found.size() < least; ++k)
    for_neighbours(cells_.geometry(), found[k], [&](Cell n) {
      if (is_frontier(n) && std::find(found.begin(), found.end(), n) == found.end()) found.push_back(n);
    });
  return found.size() >= least;
}

}  // namespace outrider::decision
