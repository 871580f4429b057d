#include "decision/grid_mdp.hpp"

#include <cassert>

namespace outrider::decision {

GridMdp::GridMdp(const Grid<std::uint8_t>& mask, std::span<const Goal> goals, double gamma, Motion motion)
    : geometry_(mask.geometry()),
      gamma_(gamma),
      motion_(motion),
      discounts_{std::pow(gamma, geometry_.resolution), std::pow(gamma, geometry_.resolution * kDiagonalLength)},
      steps_(mask.size(), kBlocked),
      goal_(mask.size(), 0.0) {
  assert(gamma > 0.0 && gamma < 1.0);
  for (std::size_t a = 0; a < 8; ++a)
    offsets_[a] = static_cast<std::ptrdiff_t>(kSteps8[a].y) * geometry_.width + kSteps8[a].x;
  std::vector<std::uint8_t> open(mask.data());
  for (const Goal& goal : goals) {
    if (!geometry_.contains(goal.cell)) continue;
    const std::size_t s = geometry_.index(goal.cell);
    open[s] = 1;
    goal_[s] = std::max(goal_[s], goal.value);
  }
  const auto free = [&](Cell c) { return geometry_.contains(c) && open[geometry_.index(c)] != 0; };
  for (std::size_t s = 0; s < open.size(); ++s) {
    if (open[s] == 0) continue;
    const Cell c = geometry_.cell_at(s);
    std::uint16_t bits = 0;
    for (std::size_t a = 0; a < 8; ++a) {
      const Cell d = kSteps8[a];
      if (free({c.x + d.x, c.y + d.y}) && free({c.x + d.x, c.y}) && free({c.x, c.y + d.y}))
        bits = static_cast<std::uint16_t>(bits | 1U << a);
    }
    steps_[s] = bits;
  }
}

}  // namespace outrider::decision
