#pragma once
// The world as an explorer hopes it to be: what is unknown is free wherever a way may lead there. Coarse enough to plan
// tours of a whole team through it, fine enough to count what each robot would see on the way.

#include <cstdint>
#include <span>
#include <vector>

#include "world/grid.hpp"

namespace outrider::decision {

/// Nodes are the connected parts of square blocks of cells that a robot can or may hope to drive over, so that walls
/// divide them however thin. What is still to be seen is a picture of pixels, kept as bits of 8 x 8 tiles.
class HopedWorld {
 public:
  using Node = std::int32_t;
  static constexpr Node kNone = -1;

  struct Edge {
    Node to = kNone;
    float metres = 0.0F;  ///< between the nodes' places
  };
  /// Some pixels of one tile.
  struct Patch {
    std::uint32_t tile = 0;
    std::uint64_t pixels = 0;
  };
  using Picture = std::vector<std::uint64_t>;  ///< one word a tile

  /// `block_cells`: edge of a node's block; `pixel_cells`: edge of a pixel [cells].
  HopedWorld(const GridGeometry& geometry, int block_cells, int pixel_cells);

  /// Follows the map; `passable` is the mask of the robot that plans. O(cells compared + changed blocks).
  void update(const OccupancyGrid& map, const Grid<std::uint8_t>& passable);
  /// Finds out which nodes may be reached from `at` and what is still to be seen there. O(nodes + tiles).
  void look_from(Cell at);

  std::size_t nodes() const { return places_.size(); }
  Node node_at(Cell c) const;
  /// The node at `c`, or else the nearest reachable one at most `most_cells` away; kNone when there is none.
  Node node_near(Cell c, int most_cells) const;
  Cell place(Node n) const { return places_[index(n)]; }
  bool reachable(Node n) const { return reached_[index(n)] != 0; }
  std::span<const Edge> edges(Node n) const { return edges_[index(n)]; }
  double straight_m(Node a, Node b) const;

  /// Pixels that hold something unknown: in reachable nodes, or next to a known free cell.
  const Picture& unseen() const { return unseen_; }
  /// Nodes that hold something unknown.
  const std::vector<Node>& unknown_nodes() const { return unknown_nodes_; }

  /// Number for a sensing range [m], to be used in view().
  int range_class(double range);
  std::size_t range_classes() const { return sensors_.size(); }
  /// What a sensor of that class sees from a node's place, through the unknown, up to known walls.
  std::span<const Patch> view(int range_class, Node n);
  double range(int range_class) const { return sensors_[static_cast<std::size_t>(range_class)].range; }  ///< [m]
  /// These pixels were looked at in vain: nothing more is hoped of them.
  void give_up(std::span<const Patch> patches);
  /// Counts up whenever update() found a change.
  std::uint64_t revision() const { return revision_; }

 private:
  static constexpr int kMostParts = 6;  // of a block; further ones, at most some cells each, are no nodes

  struct Sensor {
    double range = 0.0;
    int reach = 0;                          // [cells]
    std::vector<std::vector<Cell>> rays;    // offsets of cells, outwards
    std::vector<std::vector<Patch>> views;  // by node
    std::vector<std::uint8_t> valid;        // by node
  };

  static std::size_t index(Node n) { return static_cast<std::size_t>(n); }
  Cell block_of(Cell c) const { return {c.x / block_, c.y / block_}; }
  std::uint32_t tile_of(Cell c) const;
  std::uint64_t pixel_of(Cell c) const;
  bool open(Cell c) const;
  void relabel(Cell block);
  void describe(Node n, std::span<const Cell> cells);
  void note_fringe(Cell block);
  void connect(Cell block);
  void join(Cell inside, Cell outside);
  void invalidate_views(Cell block);
  static void add(std::vector<Patch>& patches, std::uint32_t tile, std::uint64_t pixel);

  GridGeometry geometry_, blocks_;
  int block_, pixel_, tiles_across_;
  OccupancyGrid map_;                // as of the last update
  Grid<std::uint8_t> passable_;      // likewise
  Grid<std::int8_t> part_;           // of its block that a cell belongs to, -1 none
  std::vector<Cell> places_;         // by node: block * kMostParts + part
  std::vector<std::vector<Edge>> edges_;
  std::vector<std::vector<Patch>> hopes_;   // by node: its unknown pixels
  std::vector<std::vector<Patch>> fringe_;  // by block: unknown pixels beside known free cells
  std::vector<std::uint8_t> reached_;
  std::vector<Node> unknown_nodes_;
  Picture unseen_, vain_;
  std::vector<Sensor> sensors_;
  std::uint64_t revision_ = 0;
  std::vector<Node> queue_;               // workspace
  std::vector<Cell> flood_;
};

}  // namespace outrider::decision
