#pragma once
// Where the known ends: frontier cells and their clusters, extracted anew from the map at every call.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "world/grid.hpp"

namespace outrider::decision {

/// A frontier cell is a known-free cell with an unknown 8-neighbour (Yamauchi 1997: a legal goal). What lies outside
/// the map counts as known. Plain definition, also the oracle of the fast extraction.
bool is_frontier(const OccupancyGrid& map, Cell c);

/// Calls visit(cell) for the frontier cells of the rectangle [low, high) of the map, row by row: far faster than to ask for
/// each.
template <class Visit>
void for_frontier(const OccupancyGrid& map, Cell low, Cell high, Visit&& visit) {
  constexpr int kChunk = 62;
  std::array<CellState, kChunk + 2> lowest;  // of three rows, column by column; what lies outside counts as known
  static_assert(CellState::kUnknown < CellState::kFree && CellState::kUnknown < CellState::kOccupied);
  for (int y = low.y; y < high.y; ++y)
    for (int x0 = low.x; x0 < high.x; x0 += kChunk) {
      const int x1 = std::min(x0 + kChunk, high.x);
      lowest.fill(CellState::kFree);
      for (int row = std::max(y - 1, 0); row <= std::min(y + 1, map.height() - 1); ++row)
        for (int x = std::max(x0 - 1, 0); x <= std::min(x1, map.width() - 1); ++x) {
          CellState& least = lowest[static_cast<std::size_t>(x - x0 + 1)];
          least = std::min(least, map[Cell{x, row}]);
        }
      for (int x = x0; x < x1; ++x) {
        const auto k = static_cast<std::size_t>(x - x0);
        if (map[Cell{x, y}] == CellState::kFree && std::min({lowest[k], lowest[k + 1], lowest[k + 2]}) == CellState::kUnknown)
          visit(Cell{x, y});
      }
    }
}

/// An 8-connected set of frontier cells.
struct FrontierCluster {
  std::uint32_t begin = 0, end = 0;  ///< range in Frontiers::cells
  Point centroid;                    ///< mean of the cell centres [m]
  Cell medoid;                       ///< member nearest to the centroid, ties by index
  std::size_t size() const { return end - begin; }
};

struct Frontiers {
  std::vector<std::uint32_t> cells;       ///< cell indices, grouped by cluster, ascending inside
  std::vector<FrontierCluster> clusters;  ///< ordered by smallest cell index
};

/// Extracts all frontiers of a map; owns its workspace, so that calls after the first do not allocate.
class FrontierExtractor {
 public:
  /// One streaming pass over the map and a union-find over the runs of frontier cells: O(cells + runs). The result
  /// stays valid until the next call.
  const Frontiers& extract(const OccupancyGrid& map);

 private:
  /// Frontier cells [begin, end) of row y, a node of the union-find forest. A parent never has a greater number.
  struct Run {
    int y, begin, end;
    std::uint32_t parent;
  };
  struct Sums {
    std::int64_t x = 0, y = 0;  // of the members' coordinates, exact
    int left = 0;               // column of the centroid, rounded down
    double best = 0.0;          // squared distance of the medoid so far
  };

  void detect(const OccupancyGrid& map);
  void collect_runs(int y, int width);
  void join(std::size_t above, std::size_t row);
  std::uint32_t root(std::uint32_t run);
  void number_clusters();
  void describe_clusters(const GridGeometry& g);
  void find_medoids();

  std::vector<std::uint8_t> lowest_, flags_;  // one row each
  std::vector<Run> runs_;
  std::vector<Sums> sums_;
  Frontiers result_;
};

}  // namespace outrider::decision
