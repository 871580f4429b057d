#pragma once
// Exact values of driving deterministically to discounted goals: V(s) = max_g gamma^(d(s, g)) V_g, by a wavefront.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "decision/grid_mdp.hpp"

namespace outrider::decision {

/// Value iteration on GridMdp with deterministic motion has this closed form, as distances: a goal of value V_g is a
/// source whose distance is log V_g / log gamma. Buckets as wide as the shortest step need no order within (Denardo and
/// Fox 1979): O(cells + goals log goals). After a small change only what depended on it is computed anew (Ramalingam and
/// Reps 1996), with exactly the result of a fresh start. Distances are whole multiples of a 70th of a cell.
class Wavefront {
 public:
  /// From scratch; memory is reused. Goals outside the grid are ignored.
  void compute(const Grid<std::uint8_t>& mask, std::span<const Goal> goals, double gamma);
  /// After the mask changed at most in the cells `changed` (indices) and the goals became `goals`; same grid and gamma
  /// as before. O(changed + goals log goals + affected cells).
  void update(const Grid<std::uint8_t>& mask, std::span<const std::uint32_t> changed, std::span<const Goal> goals);

  bool reached(Cell c) const;
  /// V(c); 0 where no goal can be reached.
  double value(Cell c) const;
  /// Discounted length of the best way: log V / log gamma [m]; infinite where no goal can be reached.
  double metres(Cell c) const;
  /// The best way from `from` to its goal, both included; empty when no goal can be reached.
  std::vector<Cell> path(Cell from) const;
  const GridGeometry& geometry() const { return geometry_; }
  /// All distances in a 70th of a cell, plus an offset: equal for equal values, smaller for greater ones. For
  /// comparing; 2^32 - 1 is out of reach, 0 is blocked.
  std::uint32_t level(std::size_t index) const { return levels_[padded(geometry_.cell_at(index))]; }

 private:
  struct Seed {
    std::uint32_t level, cell;
    friend auto operator<=>(const Seed&, const Seed&) = default;
  };

  std::vector<Seed> seeds_of(std::span<const Goal> goals) const;
  bool is_open(const Grid<std::uint8_t>& mask, std::uint32_t cell) const;
  std::uint32_t best_level(std::uint32_t cell) const;
  void raise(std::vector<std::uint32_t>& suspects);
  void flood(std::vector<Seed>& seeds);
  template <class Visit>
  void for_steps(std::uint32_t cell, Visit&& visit) const;
  std::uint32_t padded(Cell c) const {
    return static_cast<std::uint32_t>((c.y + 1) * (geometry_.width + 2) + c.x + 1);
  }
  Cell unpadded(std::uint32_t cell) const {
    const auto stride = static_cast<std::uint32_t>(geometry_.width + 2);
    return {static_cast<int>(cell % stride) - 1, static_cast<int>(cell / stride) - 1};
  }

  GridGeometry geometry_;
  double gamma_ = 0.9;
  std::vector<std::uint32_t> levels_;        // padded by one blocked cell all around
  std::vector<std::uint32_t> goal_levels_;   // kFar where there is no goal
  std::vector<Seed> goals_;                  // sorted
  std::vector<std::vector<std::uint32_t>> suspects_;  // by level, workspace of raise()
};

}  // namespace outrider::decision
