#pragma once
// A coarse picture of a place for planning what a team will see: blocks of cells, ways between them, views from them.

#include <cstdint>
#include <functional>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "world/grid.hpp"

namespace outrider::decision {

/// Square blocks of cells. Each is a node that robots pass through, at its drivable cell nearest to the middle, and a
/// unit that is in view or not. Ways and views are made when asked for and kept.
class CoverageGround {
 public:
  using Node = std::uint32_t;

  /// A part of a view: bits of the word `index` of a set of nodes, node n being bit n % 64 of word n / 64.
  struct Word {
    std::uint32_t index;
    std::uint64_t bits;
  };
  using View = std::vector<Word>;
  struct Leg {
    std::vector<Node> nodes;  ///< from the second to the last
    bool exists = false;
  };

  /// Blocks of `block` x `block` cells of `map`. Robots drive where `drivable`; occupied cells end a view; a block
  /// weighs as much as it has cells that count. `map` must outlive this.
  CoverageGround(const OccupancyGrid& map, const Grid<std::uint8_t>& drivable, const Grid<std::uint8_t>& counts,
                 int block);

  std::size_t nodes() const { return center_.size(); }
  const GridGeometry& geometry() const { return coarse_; }  ///< of the blocks
  Node node_of(Cell fine) const { return static_cast<Node>(coarse_.index({fine.x / block_, fine.y / block_})); }
  Cell cell_of(Node node) const { return center_[node]; }  ///< of the map, that robots pass through
  bool drivable(Node node) const { return center_[node].x >= 0; }
  int weight(Node node) const { return weights_[node]; }  ///< [cells]

  /// Nodes whose block is in view of `node` for a sensor of `range` [m]: their middle is near enough, and the line
  /// there comes as far as the block. Nothing when the node is not drivable.
  const View& view(Node node, double range);
  /// A shortest way over neighbouring blocks.
  const Leg& leg(Node from, Node to);
  double step_m(Node a, Node b) const;  ///< between neighbours [m]

 private:
  bool open(Node node, std::size_t direction) const { return (edges_[node] >> direction & 1U) != 0; }
  void survey(Node node, const Grid<std::uint8_t>& drivable, const Grid<std::uint8_t>& counts);
  void link(Node node, const Grid<std::uint8_t>& drivable);
  View make_view(Node node, double range) const;
  bool straight(Node from, Node to, Leg& leg) const;
  void search(Node from, Node to, Leg& leg);

  const OccupancyGrid& map_;
  GridGeometry coarse_;
  int block_;                        // edge of a block [cells]
  std::vector<Cell> center_;         // (-1, -1): not drivable
  std::vector<std::uint8_t> edges_;  // bit d: the neighbour in direction d can be driven to
  std::vector<int> weights_;
  std::map<double, std::vector<View>> views_;    // by range; empty: not made yet
  std::unordered_map<std::uint64_t, Leg> legs_;  // looked up, never iterated
  std::vector<std::uint32_t> distance_;          // of the last search
  std::vector<Node> toward_, touched_;
  std::vector<std::pair<std::uint32_t, Node>> heap_;
};

}  // namespace outrider::decision
