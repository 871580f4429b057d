#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "world/messages.hpp"

namespace outrider {

/// What one robot knows of the world: its own observations and what team-mates reported. Merging is commutative,
/// associative and idempotent (see CellChange), so robots that have heard the same changes, in whatever order and
/// however often, hold the same map.
class TeamMap {
 public:
  explicit TeamMap(const GridGeometry& geometry) : states_(geometry), versions_(geometry) {}

  const OccupancyGrid& states() const { return states_; }

  /// The robot's own sensor says `state` (never kUnknown). True when that was news.
  bool observe(std::uint32_t index, CellState state) {
    if (states_[index] == state) return false;
    const auto version = static_cast<std::uint8_t>(std::min(255, versions_[index] + 1));
    if (version == versions_[index] && state < states_[index]) return false;  // saturated: the greater state stands
    set(index, state, version);
    to_share_.push_back(index);
    return true;
  }

  /// A team-mate's report. True when it changed what is known.
  bool merge(const CellChange& c) {
    if (c.index >= states_.size() || c.version < versions_[c.index]) return false;
    if (c.version == versions_[c.index] && c.state <= states_[c.index]) return false;
    const bool differs = states_[c.index] != c.state;
    versions_[c.index] = c.version;
    if (differs) set(c.index, c.state, c.version);
    return differs;
  }

  /// Own observations that have not been handed out yet, each cell once, as they stand now.
  std::vector<CellChange> take_to_share() {
    std::sort(to_share_.begin(), to_share_.end());
    to_share_.erase(std::unique(to_share_.begin(), to_share_.end()), to_share_.end());
    std::vector<CellChange> changes;
    changes.reserve(to_share_.size());
    for (const std::uint32_t i : to_share_) changes.push_back({i, states_[i], versions_[i]});
    to_share_.clear();
    return changes;
  }

  /// Cells whose state changed since the last call; may name a cell twice.
  std::vector<std::uint32_t> take_changed() { return std::exchange(changed_, {}); }

 private:
  void set(std::uint32_t index, CellState state, std::uint8_t version) {
    states_[index] = state;
    versions_[index] = version;
    changed_.push_back(index);
  }

  OccupancyGrid states_;
  Grid<std::uint8_t> versions_;
  std::vector<std::uint32_t> to_share_, changed_;
};

}  // namespace outrider
