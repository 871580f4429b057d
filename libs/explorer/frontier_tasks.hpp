#pragma once
// The frontier cut into tasks, kept up to date from what changes.

#include <cstdint>
#include <map>
#include <span>
#include <unordered_map>
#include <vector>

#include "decision/footprint.hpp"
#include "decision/frontiers.hpp"
#include "decision/passability.hpp"
#include "world/robot.hpp"

namespace outrider::explorer {

/// One piece of frontier: the cell that stands for it, and what was last known of its worth.
struct FrontierTask {
  Cell cell;
  bool lone = false;           ///< its block holds too few cells of it: has it company beyond?
  Cell stand{-1, -1};          ///< where `gain` was computed for
  double gain = 0.0;           ///< area in view of `stand` that counts [m^2]
  double unseen = 0.0;         ///< the unknown part of it [m^2]
  std::uint64_t revision = 0;  ///< of the map when `gain` was computed
};

/// The tasks of one robot's map: one a block of cells and 8-connected piece of frontier within it, its first cell that a
/// robot can stand on, else its first. Neither depends on where the robot is. Blocks lie in tiles; a tile is cut anew
/// when somebody looks at it after a change.
class FrontierTasks {
 public:
  /// `map` is the robot's own and outlives this.
  FrontierTasks(const RobotSpec& spec, const OccupancyGrid& map);

  /// The map changed there, and so did the mask of passable cells. O(changed), and little: tiles are only marked.
  void update(std::span<const std::uint32_t> changed, std::span<const std::uint32_t> mask_changed);
  /// Edge of the blocks [m]. With another one than before all tiles are cut anew.
  void set_spacing(double spacing);
  /// Calls visit(FrontierTask&) for all tasks whose tile touches the square of half edge `reach` [m] around `at`, but not
  /// that of half edge `beyond`; a negative one touches nothing.
  template <class Visit>
  void for_near(const decision::Passability& passable, Cell at, double beyond, double reach, Visit&& visit) {
    const auto [low, high] = tiles_around(at, reach);
    const auto [first, last] = beyond < 0.0 ? std::pair(Cell{0, 0}, Cell{-1, -1}) : tiles_around(at, beyond);
    for (int y = low.y; y <= high.y; ++y)
      for (int x = low.x; x <= high.x; ++x) {
        if (x == first.x && first.y <= y && y <= last.y) {
          x = last.x;
          continue;
        }
        Tile& tile = tiles_[Cell{x, y}];
        if (tile.dirty) cut(tile, {x, y}, passable);
        for (FrontierTask& task : tile.tasks)
          if (!task.lone || has_company(task.cell)) visit(task);
      }
  }
  /// The unseen area in view of `stand` [m^2], or with `whole` all of it; remembered with the task until the map around
  /// changes.
  double gain(FrontierTask& task, Cell stand, bool whole) const;
  /// What gain() can be at most, without looking: knowledge grows, so what was unseen once is a bound (cells that turn
  /// from occupied to free are too rare to matter) [m^2].
  double most_gain(const FrontierTask& task, Cell stand) const { return task.stand == stand ? task.gain : most_gain(); }
  double most_gain() const { return most_gain_; }
  /// Tasks that show less than this are left-overs: a quarter of the robot's own disc, nothing that it could drive on; 0
  /// where that is less than half a cell [m^2].
  double least_gain() const { return least_gain_; }
  /// As far as is known: see gain(). A left-over never becomes more.
  bool is_left_over(const FrontierTask& task, Cell stand) const {
    return task.stand == stand && task.unseen < least_gain_;
  }
  double unseen(Cell stand) const { return footprint_.unseen_area(map_, stand); }

  /// Some frontier is left within a block's reach of `c`.
  bool frontier_near(Cell c, double spacing) const;
  /// Takes a frontier cell off the list for good. `tried`: the robot stood right there.
  void give_up(Cell c, bool tried);
  /// Takes the frontier around `task` off the list for good: nobody gets there.
  void give_up_around(Cell task, double spacing);
  /// Takes the frontier around `task` off the list until `until_s`.
  void defer(Cell task, double spacing, double until_s);
  /// Puts back what was deferred until now or earlier. True when some frontier still waits. O(deferred).
  bool any_deferred(double now_s);
  /// Was the cell given up after the robot stood right there?
  bool tried_in_vain(std::size_t index) const;

 private:
  struct Tile {
    bool dirty = true;
    std::vector<FrontierTask> tasks;  // by row, then column
  };

  bool is_frontier(Cell c) const { return decision::is_frontier(map_, c); }
  bool has_company(Cell c) const;
  std::pair<Cell, Cell> tiles_around(Cell at, double reach) const;
  Tile& tile_of(Cell c);
  void cut(Tile& tile, Cell at, const decision::Passability& passable);
  void cut_block(Cell low, Cell high, const decision::Passability& passable, std::vector<FrontierTask>& tasks) const;
  template <class Visit>
  void for_block(Cell task, double spacing, Visit&& visit);
  template <class Visit>
  void for_open(Cell low, Cell high, Visit&& visit) const;
  int block_reach(double spacing) const { return static_cast<int>(spacing / 2.0 / geometry_.resolution); }

  const OccupancyGrid& map_;
  GridGeometry geometry_;
  std::size_t least_;       // cells of a piece of frontier that is worth a task
  int block_ = 0;           // edge [cells]
  int edge_ = 0;            // of a tile [cells]
  Grid<Tile> tiles_;        // in units of tiles
  std::unordered_map<std::size_t, bool> given_up_;  // cell -> tried; looked up, never iterated
  std::map<std::size_t, double> deferred_;          // cell -> until [s]
  decision::Footprint footprint_;
  double most_gain_, least_gain_;
  int revision_edge_;                // of a block of revisions_: the footprint reaches one block far at most [cells]
  Grid<std::uint64_t> revisions_;    // when each block last changed
  std::uint64_t revision_ = 0;
};

}  // namespace outrider::explorer
