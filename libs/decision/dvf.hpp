#pragma once
// Distributed value functions (Matignon, Jeanpierre and Mouaddib 2012): where to explore, given where the others are or
// were last known to be. docs/equations.md names the readings.

#include <optional>
#include <span>
#include <vector>

#include "decision/distance_field.hpp"
#include "decision/grid_mdp.hpp"
#include "decision/grid_values.hpp"
#include "decision/wavefront.hpp"

namespace outrider::decision {

/// Where the paper leaves a choice.
struct DvfReading {
  double gamma = 0.9;   ///< discount per metre, in (0, 1)
  double reach = 3.0;   ///< l: a wave from s_j gives Pr(s'|s_j) = exp(-d(s_j, s') / l) [m]
  double kappa = 1.0;   ///< weight of the others as a whole
  bool intentions = false;  ///< the wave starts from where a robot is and from where it is heading
  Motion motion{};      ///< of the own robot
};

/// Somebody else: robot j.
struct Rival {
  Cell at;                                      ///< s_j, its last known state
  const Grid<std::uint8_t>* passable = nullptr; ///< for robots of its kind; null: of our own kind
  std::optional<Cell> goal{};                   ///< where it was heading then, if the reading counts intentions
};

/// Solves eq. 3 with eq. 7 (Algorithm 1) for robot i: exploration goals g are worth R = 1, and what the others may be
/// expected to get there, P(g) = kappa sum_j f_ij Pr(g|s_j) V_j(g), is taken off. Keeps its values between calls and
/// works where they changed. Not thread-safe.
///
/// V_j at a goal needs no solver: all goals are worth the same, so no other goal is worth leaving it for, V_emp(g) = R for
/// every kind that fits there, and f_ij = max R / max V_j = 1.
class DvfPlanner {
 public:
  explicit DvfPlanner(const DvfReading& reading) : reading_(reading) {}

  struct Plan {
    Cell goal;
    double value = 0.0;       ///< V_i(s_i)
    bool crowded_out = false; ///< every goal was worth nothing (the others take all): the values are those of eq. 1
  };
  /// The goal that the policy of V_i leads to from `at` (passable or not); nothing when it cannot get to any.
  std::optional<Plan> plan(const Grid<std::uint8_t>& mask, Cell at, std::span<const Cell> goals,
                           std::span<const Rival> rivals);

  /// V_i over all cells, as of the last plan().
  double value(Cell c) const;

 private:
  std::vector<double> shares(const Grid<std::uint8_t>& mask, std::span<const Cell> goals, std::span<const Rival> rivals);
  std::optional<Plan> follow(Cell at, std::span<const Goal> goals);
  void solve(std::span<const Goal> goals);

  DvfReading reading_;
  Grid<std::uint8_t> mask_;                // as of the last plan, the own cell open
  std::vector<std::uint32_t> changed_;     // cells of it that have changed since the wavefront was brought up to date
  Wavefront front_;
  std::optional<GridMdp> model_;           // stochastic motion
  GridValues values_;
  DistanceField wave_;
};

}  // namespace outrider::decision
