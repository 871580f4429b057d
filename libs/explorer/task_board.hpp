#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "decision/passability.hpp"
#include "decision/reach_field.hpp"
#include "explorer/frontier_tasks.hpp"
#include "world/messages.hpp"
#include "world/robot.hpp"

namespace outrider::explorer {

/// Which tasks a coordinator wants to hear of.
struct TaskGrain {
  double spacing = 1.0;      ///< one task a block of this edge and piece of frontier [m]; the paper's cells are 1 m
  std::size_t most = 256;    ///< at most so many
  bool gains = true;         ///< compute BidEntry::gain, else it is 0
  bool whole_footprint = false;  ///< gains count known cells too; the same for all calls on one board
  /// When set: tasks that cannot be among the `keep` best of the list need not be on it, and nobody searches for them. A
  /// task's bid lies between `least_bid` and `most_bid`; both never rise with the distance nor fall with the gain.
  std::function<double(const BidEntry&)> least_bid, most_bid;
  std::size_t keep = 1;
};

/// Why a frontier stays unexplored.
enum class LeftReason { kUnreachable, kTooSmall, kNotObservable };
std::string to_string(LeftReason reason);

struct Left {
  Point frontier;            ///< centroid [m]
  double unknown_m2 = 0.0;   ///< unknown cells that touch it [m^2]
  LeftReason why = LeftReason::kUnreachable;
};

/// One robot's list of things to explore: the pieces of its frontier as tasks with gain and distance, searched outwards
/// from where it is.
class TaskBoard {
 public:
  /// `map` is the robot's own: it outlives the board, and all calls mean it.
  TaskBoard(const RobotSpec& spec, const OccupancyGrid& map);

  /// The map changed in the cells `changed`, the mask of passable cells in `mask_changed`. O(changed).
  void note_changes(std::span<const std::uint32_t> changed, const decision::Passability& passable,
                    std::span<const std::uint32_t> mask_changed);
  /// The tasks that this robot can serve from cell `at` and that `grain` asks for, by task position (row, then column).
  /// Of more than `most` those that are nearest, or with bids given the best. O(cells nearer than the farthest task that
  /// may matter, and tasks nearer than one that shows a whole disc might be).
  std::vector<BidEntry> entries(const decision::Passability& passable, Cell at, const TaskGrain& grain);
  /// The shortest safe path from `at` to `stand`, both included; empty when there is none.
  std::vector<Cell> path_to(Cell at, Cell stand);
  /// Some frontier is left within a block's reach of `task`.
  bool frontier_near(Cell task, double spacing) const { return tasks_.frontier_near(task, spacing); }
  /// Going to `stand` would still show something worth the way.
  bool is_worth_it(Cell stand) const {
    return tasks_.least_gain() == 0.0 || tasks_.unseen(stand) >= tasks_.least_gain();
  }
  /// The robot is at `stand` and sees nothing new: what would be looked at from there is never tried again. O(cells).
  void give_up_from(const decision::Passability& passable, Cell stand);
  /// The frontier around `task` is never tried again: nobody gets there.
  void give_up_around(Cell task, double spacing) { tasks_.give_up_around(task, spacing); }
  /// The frontier around `task` is not offered before `until_s`: a team-mate blocks the way.
  void defer(Cell task, double spacing, double until_s) { tasks_.defer(task, spacing, until_s); }
  /// Offers again what was deferred until now or earlier. True when some frontier still waits.
  bool any_deferred(double now_s) { return tasks_.any_deferred(now_s); }
  /// Frontier clusters of `map`, which may be another, with the reason why this robot would leave each. O(cells).
  std::vector<Left> left(const OccupancyGrid& map) const;

 private:
  class Search;
  class Shortlist;

  void search_from(Cell at);
  template <class Good>
  std::optional<Cell> stand_for(Cell task, Good&& good) const;

  RobotSpec spec_;
  const OccupancyGrid& map_;
  GridGeometry geometry_;
  FrontierTasks tasks_;
  decision::ReachField field_;            // from search_at_, while that is set
  std::optional<Cell> search_at_;
  double stand_off_;                      // a robot stands no farther from a task than this [m]
  std::vector<Cell> near_;                // offsets around a task where a robot may stand, nearest first
};

}  // namespace outrider::explorer
