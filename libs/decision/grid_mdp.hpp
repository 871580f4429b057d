#pragma once
// Driving over a grid towards absorbing goals, as a Markov decision process.

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "decision/mdp.hpp"
#include "world/grid.hpp"

namespace outrider::decision {

/// A cell in which the robot may end its way, and what that is worth (> 0). It counts as passable whatever the mask says.
struct Goal {
  Cell cell;
  double value = 1.0;
};

/// What happens to a robot that intends a step.
struct Motion {
  double ahead = 1.0;  ///< probability of the intended step; else, equally likely, the step 45 degrees to either side
  bool deterministic() const { return ahead >= 1.0; }
};

/// Length of a diagonal step in cells: sqrt 2 to 5e-5, as a ratio of whole numbers, so that sums of steps are exact.
inline constexpr double kDiagonalLength = 99.0 / 70.0;

/// The eight steps counter-clockwise from +x; step a + 1 is 45 degrees to the left of step a.
inline constexpr std::array<Cell, 8> kSteps8{{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

/// States are cells, by index. Actions 0 to 7 are the eight steps; a diagonal needs both orthogonal neighbours, and a
/// step that is not possible leaves the robot where it is. gamma is per metre driven, so that policies do not depend on
/// the size of the cells: a step of length l is discounted by gamma^l. In a goal there is action 8, to end there; its
/// reward is the goal's value, and there is no other.
class GridMdp {
 public:
  /// `mask`: 1 = passable. `gamma` in (0, 1), per metre. Of two goals on one cell the greater value counts.
  GridMdp(const Grid<std::uint8_t>& mask, std::span<const Goal> goals, double gamma, Motion motion);

  std::size_t states() const { return steps_.size(); }
  int actions(State s) const { return blocked(s) ? 0 : goal_[s] > 0.0 ? 9 : 8; }
  double terminal(State) const { return 0.0; }
  double reward(State s, int a) const { return a == kEnd ? goal_[s] : 0.0; }
  double discount(State, int a) const { return a == kEnd ? 0.0 : discounts_[static_cast<std::size_t>(a & 1)]; }
  template <class Visit>
  void outcomes(State s, int a, Visit&& visit) const {
    if (a == kEnd) return visit(s, 1.0);
    visit(after(s, a), motion_.ahead);
    if (motion_.deterministic()) return;
    const double aside = (1.0 - motion_.ahead) / 2.0;
    visit(after(s, (a + 1) & 7), aside);
    visit(after(s, (a + 7) & 7), aside);
  }

  static constexpr int kEnd = 8;
  static constexpr std::uint16_t kBlocked = 256;  ///< beside the eight bits of the steps
  /// Where step `a` ends.
  State after(State s, int a) const { return possible(s, a) ? static_cast<State>(s + offsets_[static_cast<std::size_t>(a)]) : s; }
  bool possible(State s, int a) const { return (steps_[s] & 1U << a) != 0 && steps_[s] != kBlocked; }
  bool blocked(State s) const { return steps_[s] == kBlocked; }
  double goal(State s) const { return goal_[s]; }  ///< 0: none
  std::uint16_t step_bits(State s) const { return steps_[s]; }  ///< a bit a possible step; 256: blocked
  const Motion& motion() const { return motion_; }
  const GridGeometry& geometry() const { return geometry_; }
  double gamma() const { return gamma_; }

 private:
  GridGeometry geometry_;
  double gamma_;
  Motion motion_;
  std::array<double, 2> discounts_;     // of a step along an axis, of a diagonal
  std::array<std::ptrdiff_t, 8> offsets_;
  std::vector<std::uint16_t> steps_;    // a bit a possible step
  std::vector<double> goal_;            // 0: none
};

static_assert(MarkovDecisionProcess<GridMdp>);

}  // namespace outrider::decision
