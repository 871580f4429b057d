#include "world/team_map.hpp"

#include "world/cell_finder.hpp"

namespace outrider {
namespace {

/// splitmix64's finaliser: every bit of the result depends on every bit of the argument.
std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

/// A cell's part of the hash; nothing for a cell that nobody has seen.
std::uint64_t cell_hash(std::uint32_t index, std::uint8_t value) {
  return value == 0 ? 0 : mix((static_cast<std::uint64_t>(index) << 8U | value) + 0x9E3779B97F4A7C15U);
}

CellState state_of(std::uint8_t value) { return static_cast<CellState>(value & 3U); }

/// Of a cell that was seen once.
std::uint8_t first_value(CellState state) { return static_cast<std::uint8_t>(4U + static_cast<unsigned>(state)); }

}  // namespace

TeamMap::TeamMap(const GridGeometry& geometry)
    : tiling_{geometry}, states_(geometry), values_(tiling_.count()), marks_(tiling_.count()) {}

bool TeamMap::observe(std::uint32_t index, CellState state) {
  if (states_[index] == state) return false;
  const Cell at = states_.geometry().cell_at(index);
  const int version = std::min(kMostVersions, (value(index, tiling_.tile_at(at)) >> 2) + 1);
  if (!raise(index, at, static_cast<std::uint8_t>(version * 4 + static_cast<int>(state)))) return false;
  to_share_.push_back(index);
  return true;
}

bool TeamMap::merge(const CellRun& run) {
  bool news = false;
  CellFinder cell_at(states_.geometry());
  for (std::uint32_t k = 0; k < run.length && run.index + k < states_.size(); ++k)
    news = raise(run.index + k, cell_at(run.index + k), run.value) || news;
  return news;
}

bool TeamMap::merge_tile(std::size_t tile, std::span<const std::uint8_t> cells) {
  std::size_t expected = 0;
  if (tile < marks_.size()) tiling_.for_cells(tile, [&](std::size_t) { ++expected; });
  if (tile >= marks_.size() || cells.size() != expected) return false;
  bool news = false;
  std::size_t k = 0;
  CellFinder cell_at(states_.geometry());
  tiling_.for_cells(tile, [&](std::size_t i) {
    news = raise(static_cast<std::uint32_t>(i), cell_at(i), cells[k++]) || news;
  });
  return news;
}

std::vector<std::uint8_t> TeamMap::tile(std::size_t tile) const {
  std::vector<std::uint8_t> cells;
  tiling_.for_cells(tile, [&](std::size_t i) { cells.push_back(value(i, tile)); });
  return cells;
}

std::vector<CellRun> TeamMap::take_to_share() {
  std::sort(to_share_.begin(), to_share_.end());
  to_share_.erase(std::unique(to_share_.begin(), to_share_.end()), to_share_.end());
  std::vector<CellRun> runs;
  CellFinder cell_at(states_.geometry());
  for (const std::uint32_t i : to_share_) {
    const std::uint8_t v = value(i, tiling_.tile_at(cell_at(i)));
    const bool goes_on = !runs.empty() && runs.back().index + runs.back().length == i && runs.back().value == v &&
                         runs.back().length < 255;
    if (goes_on) ++runs.back().length;
    else runs.push_back({i, 1, v});
  }
  to_share_.clear();
  return runs;
}

/// Number of a cell within its tile, wherever that ends.
std::size_t TeamMap::in_tile(Cell at) {
  return static_cast<std::size_t>(at.y % Tiling::kEdge * Tiling::kEdge + at.x % Tiling::kEdge);
}

std::uint8_t TeamMap::value(std::size_t index, std::size_t tile) const {
  const CellState state = states_[index];
  if (!values_[tile].empty()) return values_[tile][in_tile(states_.geometry().cell_at(index))];
  return state == CellState::kUnknown ? std::uint8_t{0} : first_value(state);
}

void TeamMap::set_value(std::size_t index, std::size_t tile, std::uint8_t v) {
  if (values_[tile].empty()) {
    if (v == first_value(state_of(v)) && v != first_value(CellState::kUnknown)) return;
    std::vector<std::uint8_t> values(static_cast<std::size_t>(Tiling::kEdge) * Tiling::kEdge, 0);
    tiling_.for_cells(tile, [&](std::size_t i) { values[in_tile(states_.geometry().cell_at(i))] = value(i, tile); });
    values_[tile] = std::move(values);
  }
  values_[tile][in_tile(states_.geometry().cell_at(index))] = v;
}

/// Sets a cell when `value` is greater than what is known. True when its state changed.
bool TeamMap::raise(std::uint32_t index, Cell at, std::uint8_t v) {
  const std::size_t tile = tiling_.tile_at(at);
  const std::uint8_t before = value(index, tile);
  const CellState state = state_of(v);
  if (v <= before || state > CellState::kOccupied) return false;
  set_value(index, tile, v);
  TileMark& mark = marks_[tile];
  const std::uint64_t change = cell_hash(index, before) ^ cell_hash(index, v);
  mark.weight += v - before;
  mark.hash ^= static_cast<std::uint32_t>(change);
  hash_ ^= change;
  if (states_[index] == state) return false;
  states_[index] = state;
  changed_.push_back(index);
  return true;
}

}  // namespace outrider
