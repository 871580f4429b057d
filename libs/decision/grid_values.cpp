#include "decision/grid_values.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace outrider::decision {
namespace {

constexpr std::uint32_t kFar = std::numeric_limits<std::uint32_t>::max();
constexpr unsigned kBandBits = 7;  // bands of 1.8 cells: about one step wide
// Where nothing better is known a state starts as if straying made its way this much longer: rather too low than too
// high, as what is too high takes long to sink.
constexpr double kDetour = 1.25;

}  // namespace

/// max_a Q(s, a) and the action. The eight successors are looked up once for all actions.
std::pair<double, int> GridValues::backup(const GridMdp& model, State s) const {
  std::array<double, 10> v;  // v[a + 1]: after step a; the ends repeat
  for (int a = 0; a < 8; ++a) v[static_cast<std::size_t>(a) + 1] = values_[model.after(s, a)];
  v[0] = v[8];
  v[9] = v[1];
  const double ahead = model.motion().ahead, aside = (1.0 - ahead) / 2.0;
  std::pair<double, int> best{0.0, kNoAction};
  for (int a = 0; a < 8; ++a) {
    const auto k = static_cast<std::size_t>(a) + 1;
    const double q = model.discount(s, a) * (ahead * v[k] + aside * (v[k - 1] + v[k + 1]));
    if (q > best.first) best = {q, a};
  }
  if (model.goal(s) > best.first) best = {model.goal(s), GridMdp::kEnd};
  return best;
}

void GridValues::queue(State s) {
  if (queued_[s]) return;
  queued_[s] = 1;
  const std::size_t band = (levels_[s] - base_) >> kBandBits;
  buckets_[band].push_back(s);
  lowest_ = std::min(lowest_, band);
}

/// The value of `s` changed by that much: whoever may come here has to know.
void GridValues::touch(const GridMdp& model, State s, double change) {
  for (int a = 0; a < 8; ++a) {
    const State n = model.after(s, a);
    if (n == s) continue;
    pending_[n] += change;
    if (pending_[n] > tolerance * values_[n]) queue(n);
  }
  pending_[s] += change;  // a step that is not possible stays here
  if (pending_[s] > tolerance * values_[s]) queue(s);
}

/// Notes the new model and order; states to which the way has changed start anew. Returns those to begin with.
std::vector<State> GridValues::take_in(const GridMdp& model, const Wavefront& order) {
  const std::size_t n = model.states();
  std::vector<State> changed;
  std::uint32_t least = kFar, most = 0;
  for (State s = 0; s < n; ++s) {
    const std::uint32_t level = order.level(s) == 0 ? kFar : order.level(s);
    if (level != kFar) {
      least = std::min(least, level);
      most = std::max(most, level);
    }
    if (level == levels_[s] && known_steps_[s] == model.step_bits(s) && known_goals_[s] == model.goal(s)) continue;
    if (level == kFar) values_[s] = 0.0;
    else changed.push_back(s);
    if (level != kFar && level != levels_[s])
      values_[s] = std::pow(model.gamma(), kDetour * order.metres(geometry_.cell_at(s)));
    levels_[s] = level;
    known_steps_[s] = model.step_bits(s);
    known_goals_[s] = model.goal(s);
  }
  base_ = least;
  buckets_.clear();
  if (least != kFar) buckets_.resize(((most - least) >> kBandBits) + 1);
  lowest_ = buckets_.size();
  return changed;
}

void GridValues::solve(const GridMdp& model, const Wavefront& order) {
  if (geometry_ != model.geometry() || values_.size() != model.states()) {  // cold
    geometry_ = model.geometry();
    values_.assign(model.states(), 0.0);
    pending_.assign(model.states(), 0.0);
    queued_.assign(model.states(), 0);
    levels_.assign(model.states(), kFar);
    known_steps_.assign(model.states(), model.kBlocked);
    known_goals_.assign(model.states(), 0.0);
  }
  backups_ = 0;
  const std::vector<State> changed = take_in(model, order);
  for (const State s : changed) {
    queue(s);
    for (int a = 0; a < 8; ++a)
      if (const State near = model.after(s, a); levels_[near] != kFar) queue(near);
  }
  work_off(model);
}

/// Backs up what is queued, the lowest band first, until nothing is.
void GridValues::work_off(const GridMdp& model) {
  std::vector<State> now;
  while (lowest_ < buckets_.size()) {
    now.clear();
    std::swap(now, buckets_[lowest_++]);
    for (const State s : now) {
      queued_[s] = 0;
      pending_[s] = 0.0;
      ++backups_;
      const double before = values_[s], after = backup(model, s).first;
      values_[s] = after;
      if (after != before) touch(model, s, std::abs(after - before));
    }
  }
}

int GridValues::action(const GridMdp& model, Cell c) const {
  return backup(model, static_cast<State>(geometry_.index(c))).second;
}

std::vector<Cell> GridValues::path(const GridMdp& model, Cell from) const {
  std::vector<Cell> cells;
  if (!geometry_.contains(from) || value(from) <= 0.0) return cells;
  auto s = static_cast<State>(geometry_.index(from));
  cells.push_back(from);
  for (std::size_t k = 0; k < values_.size(); ++k) {
    const int a = backup(model, s).second;
    if (a == GridMdp::kEnd) return cells;
    if (a == kNoAction || model.after(s, a) == s) break;
    s = model.after(s, a);
    cells.push_back(geometry_.cell_at(s));
  }
  return {};
}

}  // namespace outrider::decision
