#pragma once
// Values of driving to discounted goals when steps may go astray: Gauss-Seidel in the order of the wavefront.

#include <cstdint>
#include <vector>

#include "decision/grid_mdp.hpp"
#include "decision/wavefront.hpp"

namespace outrider::decision {

/// Solves GridMdp for stochastic motion. Works from the goals outwards, as values depend mostly on what is nearer to a
/// goal, and backs up a state again only when those it depends on have changed: the sum of their changes since, which is
/// tracked, bounds its residual. A second call starts from the first one's values and works where the model, or the way
/// to the goals, has changed. About 10 backups a state from scratch, where sweeps need 100 and more.
class GridValues {
 public:
  double tolerance = 1e-4;  ///< of a state's value: its largest residual in the end

  /// `order`: the wavefront of the same mask and goals, which is the solution for deterministic motion.
  void solve(const GridMdp& model, const Wavefront& order);

  double value(Cell c) const { return values_[geometry_.index(c)]; }
  const std::vector<double>& values() const { return values_; }
  /// The best action in `c` (see GridMdp), kNoAction where no goal can be reached.
  int action(const GridMdp& model, Cell c) const;
  /// Where the policy leads when every step goes as intended: `from` first, a goal last. Empty when it leads nowhere.
  std::vector<Cell> path(const GridMdp& model, Cell from) const;
  std::uint64_t backups() const { return backups_; }  ///< of the last solve()

 private:
  std::pair<double, int> backup(const GridMdp& model, State s) const;
  std::vector<State> take_in(const GridMdp& model, const Wavefront& order);
  void work_off(const GridMdp& model);
  void touch(const GridMdp& model, State s, double change);
  void queue(State s);

  GridGeometry geometry_;
  std::vector<double> values_, pending_;      // pending: what a state's successors changed by since its last backup
  std::vector<std::uint8_t> queued_;
  std::vector<std::uint32_t> levels_;         // of the order
  std::vector<std::vector<State>> buckets_;   // by level
  std::size_t lowest_ = 0;
  std::uint32_t base_ = 0;
  std::uint64_t backups_ = 0;
  std::vector<std::uint16_t> known_steps_;    // the model of the last call
  std::vector<double> known_goals_;
};

}  // namespace outrider::decision
