#pragma once
// The goal-oriented MDP of Lozenguez et al. 2015, eq. 2 to 5, solved exactly.
//
// With R = G_i \ G_s the goals that are left, and J(w, R) the least expected cost of reaching them all from w,
//     V_i(w, G_s) = r_g |R| - J(w, R),      J(w, {}) = 0, or D(w, home) when the mission ends at home,
//     J(w, R) = J(w, R \ {w})               for w in R: validating a goal is free (eq. 4)
//             = min_p c_p + sum_w' d_p(w') J(w', R)   else (eq. 3, 5 with r = -c_p and gamma = 1).
// r_g cancels from every comparison. J depends on neither G_i nor the robot, so one table serves all iterations of an
// auction and all robots of a map; only what is asked for is solved. Goal sets form a lattice: R needs only its subsets.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "decision/legs.hpp"
#include "world/task_set.hpp"

namespace outrider::decision {

class GoMdp {
 public:
  static constexpr int kMostForTable = 20;  ///< goals for which solve_all() fits into memory

  /// `places`: waypoints that cost() will be asked for (starts), beside the goals; others are possible but slower on
  /// maps with deviation. `map` must outlive this.
  GoMdp(const TopologicalMap& map, std::vector<int> goals, std::vector<int> places = {}, std::optional<int> home = {});

  const Legs& legs() const { return legs_; }
  /// J(w, R); infinity when R cannot be reached almost surely. Solves what is missing: deterministic, at most
  /// O(2^|R| |R| |G|) (Held and Karp 1962); with deviation O(2^|R| |W| paths outcomes sweeps), 16 sets at a time, to a
  /// relative residual of 1e-6.
  double cost(int waypoint, const TaskSet& R);
  /// pi*(w, R): index of the path to take; -1 when nothing is left to do, or nothing can be done.
  int best_path(int waypoint, const TaskSet& R);
  /// The goals of R in the order in which the optimal policy visits them when every path leads where it should.
  std::vector<int> order(int waypoint, const TaskSet& R);
  /// Solves all subsets of the goals, at most kMostForTable of them. 4 |G| 2^|G| bytes when deterministic.
  void solve_all();
  /// Goal sets solved so far.
  std::size_t sets() const { return filled_; }

 private:
  static constexpr std::size_t kLanes = 16;
  using Slot = std::uint32_t;
  static constexpr Slot kMissing = ~Slot{0};

  Slot slot(const TaskSet& R) const;
  Slot add(const TaskSet& R);
  float& at(Slot row, int place) { return rows_[row * kept_.size() + static_cast<std::size_t>(place)]; }
  /// J(g, R) of a goal g, from the table.
  float solved(const TaskSet& R, int goal) { return at(slot(R), goal); }

  void require(const TaskSet& R);
  void fill_deterministic(const TaskSet& R, Slot row);
  void collect(const TaskSet& R, std::vector<std::vector<TaskSet>>& by_size);
  /// Values of all waypoints (waypoint x kLanes) for up to kLanes goal sets whose subsets are solved.
  void solve_batch(const TaskSet* sets, std::size_t n);
  bool relax(std::size_t waypoint);
  const std::vector<float>& values_of(const TaskSet& R);

  const TopologicalMap& map_;
  Legs legs_;
  bool deterministic_;
  std::vector<int> kept_;      // waypoints whose values are kept: the goals, then other places
  std::vector<int> place_of_;  // waypoint -> index in kept_, -1
  std::vector<std::vector<int>> outgoing_;
  std::vector<float> toward_;  // D(kept place, goal), goal-major

  bool complete_ = false;                                   // row of R = R as a number
  std::vector<Slot> direct_;                                // up to kMostForTable goals
  std::unordered_map<TaskSet, Slot, TaskSet::Hash> sparse_; // more
  std::vector<float> rows_;
  std::size_t filled_ = 0;

  // The batch solver's view of the map and its workspace.
  struct Move {
    float cost, scale;             // c_p and 1 / (1 - probability to stay)
    std::uint32_t first, last;     // outcomes
  };
  std::vector<Move> moves_;
  std::vector<std::uint32_t> first_move_;  // by waypoint, |W| + 1
  std::vector<std::pair<std::uint32_t, float>> outcomes_;
  std::vector<float> values_, fixed_, member_;
  TaskSet values_set_;
  std::vector<float> single_;
  bool single_valid_ = false;
};

}  // namespace outrider::decision
