#pragma once

#include <optional>
#include <map>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "decision/distance_field.hpp"
#include "decision/footprint.hpp"
#include "decision/frontiers.hpp"
#include "decision/passability.hpp"
#include "world/messages.hpp"
#include "world/robot.hpp"

namespace outrider::explorer {

/// How fine the tasks of a frontier are.
struct TaskGrain {
  double spacing = 1.0;      ///< one task a block of this edge and cluster [m]; the paper's cells are 1 m
  std::size_t most = 256;    ///< more tasks than this double the spacing until they fit
  bool gains = true;         ///< compute BidEntry::gain, else it is 0
  bool whole_footprint = false;  ///< gains count known cells too; the same for all calls on one board
};

/// Why a frontier stays unexplored.
enum class LeftReason { kUnreachable, kTooSmall, kNotObservable };
std::string to_string(LeftReason reason);

struct Left {
  Point frontier;            ///< centroid [m]
  double unknown_m2 = 0.0;   ///< unknown cells that touch it [m^2]
  LeftReason why = LeftReason::kUnreachable;
};

/// One robot's list of things to explore: frontier clusters of its map as tasks with gain and distance.
class TaskBoard {
 public:
  TaskBoard(const RobotSpec& spec, const GridGeometry& geometry);

  /// All tasks that this robot can serve from cell `at`, by task position (row, then column).
  std::vector<BidEntry> entries(const OccupancyGrid& map, const decision::Passability& passable, Cell at,
                                const TaskGrain& grain);
  /// The map changed there: gains of tasks within sight of it are computed anew.
  void note_changes(std::span<const std::uint32_t> changed);
  /// The shortest safe path from `at` to `stand`, both included; empty when there is none. Reuses the distances of the
  /// last entries() when they still hold.
  std::vector<Cell> path_to(const Grid<std::uint8_t>& passable, Cell at, Cell stand);
  /// The task was served and is still a frontier: never try it again from here.
  void give_up(Cell task, Cell stand, double spacing, const OccupancyGrid& map);
  bool given_up(Cell task) const { return given_up_.contains({task.y, task.x}); }
  /// Frontier clusters of `map` with the reason why this robot would leave each.
  std::vector<Left> left(const OccupancyGrid& map);

 private:
  bool too_small(const decision::FrontierCluster& cluster) const;
  std::vector<Cell> representatives(const decision::Passability& passable,
                                    const decision::Frontiers& frontiers, double spacing) const;
  std::optional<Cell> stand_for(const OccupancyGrid& map, Cell task) const;

  RobotSpec spec_;
  GridGeometry geometry_;
  decision::FrontierExtractor extractor_;
  decision::DistanceField field_;         // from field_at_
  Cell field_at_{-1, -1};
  decision::Footprint footprint_;
  double gain_at(const OccupancyGrid& map, Cell stand, bool whole);

  struct Gain {
    std::uint64_t revision;  // of the map around, when computed
    double area;             // [m^2]
  };
  std::unordered_map<std::uint64_t, Gain> gains_;  // by cell index; looked up, never iterated
  Grid<std::uint64_t> revisions_;                  // of each block of the map; a block is a sensing range wide
  std::uint64_t revision_ = 0;
  std::vector<Cell> near_;                // offsets around a task where a robot may stand, nearest first
  std::map<std::pair<int, int>, bool> given_up_;  // (row, column) -> the robot stood right there
};

}  // namespace outrider::explorer
