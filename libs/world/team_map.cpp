#include "world/team_map.hpp"

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

}  // namespace

TeamMap::TeamMap(const GridGeometry& geometry)
    : tiling_{geometry}, states_(geometry), values_(geometry), marks_(tiling_.count()) {}

bool TeamMap::observe(std::uint32_t index, CellState state) {
  if (states_[index] == state) return false;
  const int version = std::min(kMostVersions, (values_[index] >> 2) + 1);
  if (!raise(index, static_cast<std::uint8_t>(version * 4 + static_cast<int>(state)))) return false;
  to_share_.push_back(index);
  return true;
}

bool TeamMap::merge(const CellRun& run) {
  bool news = false;
  for (std::uint32_t k = 0; k < run.length && run.index + k < states_.size(); ++k)
    news = raise(run.index + k, run.value) || news;
  return news;
}

bool TeamMap::merge_tile(std::size_t tile, std::span<const std::uint8_t> cells) {
  std::size_t expected = 0;
  if (tile < marks_.size()) tiling_.for_cells(tile, [&](std::size_t) { ++expected; });
  if (tile >= marks_.size() || cells.size() != expected) return false;
  bool news = false;
  std::size_t k = 0;
  tiling_.for_cells(tile, [&](std::size_t i) { news = raise(static_cast<std::uint32_t>(i), cells[k++]) || news; });
  return news;
}

std::vector<std::uint8_t> TeamMap::tile(std::size_t tile) const {
  std::vector<std::uint8_t> cells;
  tiling_.for_cells(tile, [&](std::size_t i) { cells.push_back(values_[i]); });
  return cells;
}

std::vector<CellRun> TeamMap::take_to_share() {
  std::sort(to_share_.begin(), to_share_.end());
  to_share_.erase(std::unique(to_share_.begin(), to_share_.end()), to_share_.end());
  std::vector<CellRun> runs;
  for (const std::uint32_t i : to_share_) {
    const bool goes_on = !runs.empty() && runs.back().index + runs.back().length == i &&
                         runs.back().value == values_[i] && runs.back().length < 255;
    if (goes_on) ++runs.back().length;
    else runs.push_back({i, 1, values_[i]});
  }
  to_share_.clear();
  return runs;
}

/// Sets a cell when `value` is greater than what is known. True when its state changed.
bool TeamMap::raise(std::uint32_t index, std::uint8_t value) {
  const std::uint8_t before = values_[index];
  const CellState state = state_of(value);
  if (value <= before || state > CellState::kOccupied) return false;
  values_[index] = value;
  TileMark& mark = marks_[tiling_.tile_of(index)];
  const std::uint64_t change = cell_hash(index, before) ^ cell_hash(index, value);
  mark.weight += value - before;
  mark.hash ^= static_cast<std::uint32_t>(change);
  hash_ ^= change;
  if (states_[index] == state) return false;
  states_[index] = state;
  changed_.push_back(index);
  return true;
}

}  // namespace outrider
