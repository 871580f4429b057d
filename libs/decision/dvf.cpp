#include "decision/dvf.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace outrider::decision {
namespace {

constexpr double kNegligible = 1e-3;  // a wave ends where its probability is less

/// Brings `copy` up to `mask`; appends the cells that differ.
void follow_mask(Grid<std::uint8_t>& copy, const Grid<std::uint8_t>& mask, std::vector<std::uint32_t>& changed) {
  const std::size_t width = static_cast<std::size_t>(mask.width());
  for (std::size_t row = 0; row < mask.size(); row += width) {
    std::uint8_t* old = copy.data().data() + row;
    const std::uint8_t* now = mask.data().data() + row;
    if (std::memcmp(old, now, width) == 0) continue;
    for (std::size_t x = 0; x < width; ++x)
      if (old[x] != now[x]) changed.push_back(static_cast<std::uint32_t>(row + x));
    std::memcpy(old, now, width);
  }
}

}  // namespace

/// sum_j f_ij Pr(g|s_j) V_j(g) / R for each goal: eq. 7 by a wave from each rival's last known state.
std::vector<double> DvfPlanner::shares(const Grid<std::uint8_t>& mask, std::span<const Cell> goals,
                                       std::span<const Rival> rivals) {
  std::vector<double> sums(goals.size(), 0.0);
  for (const Rival& rival : rivals) {
    std::vector<Cell> sources{rival.at};
    if (rival.goal) sources.push_back(*rival.goal);
    wave_.compute(rival.passable != nullptr ? *rival.passable : mask, sources, -reading_.reach * std::log(kNegligible));
    for (std::size_t k = 0; k < goals.size(); ++k)
      if (wave_.reached(goals[k])) sums[k] += std::exp(-wave_.metres(goals[k]) / reading_.reach);
  }
  return sums;
}

std::optional<DvfPlanner::Plan> DvfPlanner::plan(const Grid<std::uint8_t>& mask, Cell at, std::span<const Cell> goals,
                                                 std::span<const Rival> rivals) {
  if (mask_.geometry() == mask.geometry()) {
    follow_mask(mask_, mask, changed_);
  } else {
    mask_ = mask;
    front_ = {};
  }
  if (!mask_[at]) {
    mask_[at] = 1;
    changed_.push_back(static_cast<std::uint32_t>(mask_.geometry().index(at)));
  }
  const std::vector<double> taken = shares(mask, goals, rivals);
  std::vector<Goal> worth;
  for (std::size_t k = 0; k < goals.size(); ++k)
    if (const double value = 1.0 - reading_.kappa * taken[k]; value > 0.0) worth.push_back({goals[k], value});
  if (auto found = follow(at, worth)) return found;
  worth.clear();
  for (const Cell goal : goals) worth.push_back({goal, 1.0});
  auto found = follow(at, worth);
  if (found) found->crowded_out = true;
  return found;
}

void DvfPlanner::solve(std::span<const Goal> goals) {
  if (front_.geometry() == mask_.geometry()) front_.update(mask_, changed_, goals);
  else front_.compute(mask_, goals, reading_.gamma);
  changed_.clear();
  if (reading_.motion.deterministic()) return;
  model_.emplace(mask_, goals, reading_.gamma, reading_.motion);
  values_.solve(*model_, front_);
}

std::optional<DvfPlanner::Plan> DvfPlanner::follow(Cell at, std::span<const Goal> goals) {
  solve(goals);
  const std::vector<Cell> way = reading_.motion.deterministic() ? front_.path(at) : values_.path(*model_, at);
  if (way.empty()) return std::nullopt;
  return Plan{way.back(), value(at)};
}

double DvfPlanner::value(Cell c) const {
  return reading_.motion.deterministic() ? front_.value(c) : values_.value(c);
}

}  // namespace outrider::decision
