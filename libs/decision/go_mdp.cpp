#include "decision/go_mdp.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace outrider::decision {
namespace {

constexpr float kResidual = 1e-6F;
constexpr int kMostSweeps = 10000;

}  // namespace

GoMdp::GoMdp(const TopologicalMap& map, std::vector<int> goals, std::vector<int> places, std::optional<int> home)
    : map_(map), legs_(map, std::move(goals), home), deterministic_(map.deterministic()),
      place_of_(map.waypoints.size(), -1), outgoing_(map.outgoing()) {
  const auto keep = [&](int waypoint) {
    int& place = place_of_[static_cast<std::size_t>(waypoint)];
    if (place >= 0) return;
    place = static_cast<int>(kept_.size());
    kept_.push_back(waypoint);
  };
  for (int g = 0; g < legs_.goals(); ++g) keep(legs_.waypoint(g));
  if (!deterministic_) std::for_each(places.begin(), places.end(), keep);
  if (legs_.goals() <= kMostForTable) direct_.assign(std::size_t{1} << legs_.goals(), kMissing);
  const Slot none = add({});
  for (std::size_t k = 0; k < kept_.size(); ++k) at(none, static_cast<int>(k)) = legs_.home(kept_[k]);
  for (int g = 0; g < legs_.goals(); ++g)
    for (const int w : kept_) toward_.push_back(legs_.from(w, g));
  if (deterministic_) return;
  for (std::size_t w = 0; w < map.waypoints.size(); ++w) {
    first_move_.push_back(static_cast<std::uint32_t>(moves_.size()));
    for (const int p : outgoing_[w]) {
      const Path& path = map.paths[static_cast<std::size_t>(p)];
      Move move{static_cast<float>(path.cost), 1.0F, static_cast<std::uint32_t>(outcomes_.size()), 0};
      double stay = 0.0;
      for (const Outcome& o : path.outcomes) {
        if (o.waypoint == path.from) stay += o.probability;
        else outcomes_.emplace_back(static_cast<std::uint32_t>(o.waypoint), static_cast<float>(o.probability));
      }
      move.last = static_cast<std::uint32_t>(outcomes_.size());
      move.scale = static_cast<float>(1.0 / (1.0 - stay));
      if (stay < 1.0) moves_.push_back(move);
    }
  }
  first_move_.push_back(static_cast<std::uint32_t>(moves_.size()));
}

GoMdp::Slot GoMdp::slot(const TaskSet& R) const {
  if (complete_) return static_cast<Slot>(R.low());
  if (!direct_.empty()) return direct_[R.low()];
  const auto it = sparse_.find(R);
  return it == sparse_.end() ? kMissing : it->second;
}

GoMdp::Slot GoMdp::add(const TaskSet& R) {
  const auto row = static_cast<Slot>(filled_++);
  rows_.resize(filled_ * kept_.size());
  if (complete_) return row;
  if (!direct_.empty()) direct_[R.low()] = row;
  else sparse_.emplace(R, row);
  return row;
}

/// F(:, R) = min_h D(:, h) + F(h, R \ h): for the goals in R themselves the least is h = w, by the triangle inequality.
void GoMdp::fill_deterministic(const TaskSet& R, Slot row) {
  const std::size_t n = kept_.size();
  float* const out = &rows_[row * n];
  std::fill(out, out + n, kNoWay);
  R.for_each([&](int h) {
    const float rest = solved(R.without(h), h);
    const float* const leg = &toward_[static_cast<std::size_t>(h) * n];
    for (std::size_t k = 0; k < n; ++k) out[k] = std::min(out[k], leg[k] + rest);
  });
}

void GoMdp::collect(const TaskSet& R, std::vector<std::vector<TaskSet>>& by_size) {
  if (slot(R) != kMissing) return;
  add(R);
  R.for_each([&](int h) { collect(R.without(h), by_size); });
  by_size[static_cast<std::size_t>(R.size())].push_back(R);
}

/// Solves R and all its subsets that are missing. What is in the table has all its subsets there.
void GoMdp::require(const TaskSet& R) {
  if (slot(R) != kMissing) return;
  if (deterministic_) {
    R.for_each([&](int h) { require(R.without(h)); });
    fill_deterministic(R, add(R));
    return;
  }
  std::vector<std::vector<TaskSet>> by_size(static_cast<std::size_t>(R.size()) + 1);
  collect(R, by_size);
  for (const auto& layer : by_size)
    for (std::size_t first = 0; first < layer.size(); first += kLanes) {
      const std::size_t n = std::min(kLanes, layer.size() - first);
      solve_batch(&layer[first], n);
      for (std::size_t lane = 0; lane < n; ++lane)
        for (std::size_t k = 0; k < kept_.size(); ++k)
          at(slot(layer[first + lane]), static_cast<int>(k)) = values_[static_cast<std::size_t>(kept_[k]) * kLanes + lane];
    }
}

void GoMdp::solve_batch(const TaskSet* sets, std::size_t n) {
  const auto goals = static_cast<std::size_t>(legs_.goals());
  const std::size_t places = map_.waypoints.size();
  // What is known of each set: J(g, R \ g) at its goals.
  fixed_.assign(goals * kLanes, kNoWay);
  member_.assign(goals * kLanes, 0.0F);
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const TaskSet& R = sets[std::min(lane, n - 1)];
    R.for_each([&](int g) {
      fixed_[static_cast<std::size_t>(g) * kLanes + lane] = solved(R.without(g), g);
      member_[static_cast<std::size_t>(g) * kLanes + lane] = 1.0F;
    });
  }
  // Begin with the value of committing to one goal next: an upper bound.
  values_.assign(places * kLanes, kNoWay);
  for (std::size_t w = 0; w < places; ++w) {
    float* const v = &values_[w * kLanes];
    for (std::size_t g = 0; g < goals; ++g) {
      const float leg = legs_.from(static_cast<int>(w), static_cast<int>(g));
      const float* const rest = &fixed_[g * kLanes];
      for (std::size_t l = 0; l < kLanes; ++l) v[l] = std::min(v[l], leg + rest[l]);
    }
  }
  // Gauss-Seidel sweeps, forwards and backwards in turn; values only fall.
  bool changed = true;
  for (int sweep = 0; changed && sweep < kMostSweeps; ++sweep) {
    changed = false;
    for (std::size_t i = 0; i < places; ++i) changed = relax(sweep % 2 == 0 ? i : places - 1 - i) || changed;
  }
}

/// One Bellman update of a waypoint in all lanes; true when a value fell by more than the residual.
bool GoMdp::relax(std::size_t w) {
  std::array<float, kLanes> best;
  best.fill(kNoWay);
  for (std::uint32_t m = first_move_[w]; m < first_move_[w + 1]; ++m) {
    std::array<float, kLanes> sum;
    sum.fill(moves_[m].cost);
    for (std::uint32_t o = moves_[m].first; o < moves_[m].last; ++o) {
      const float p = outcomes_[o].second;
      const float* const next = &values_[outcomes_[o].first * kLanes];
      for (std::size_t l = 0; l < kLanes; ++l) sum[l] += p * next[l];
    }
    for (std::size_t l = 0; l < kLanes; ++l) best[l] = std::min(best[l], sum[l] * moves_[m].scale);
  }
  if (const int g = legs_.goal_at(static_cast<int>(w)); g >= 0) {
    const float* const fixed = &fixed_[static_cast<std::size_t>(g) * kLanes];
    const float* const member = &member_[static_cast<std::size_t>(g) * kLanes];
    for (std::size_t l = 0; l < kLanes; ++l) best[l] = member[l] != 0.0F ? fixed[l] : best[l];
  }
  float* const v = &values_[w * kLanes];
  float fell = 0.0F;
  for (std::size_t l = 0; l < kLanes; ++l) {
    const bool less = best[l] < v[l];
    fell = std::max(fell, less ? v[l] - best[l] - kResidual * best[l] : 0.0F);
    v[l] = less ? best[l] : v[l];
  }
  return fell > 0.0F;
}

double GoMdp::cost(int waypoint, const TaskSet& R) {
  if (R.empty()) return legs_.home(waypoint);
  if (const int g = legs_.goal_at(waypoint); g >= 0 && R.contains(g)) return cost(waypoint, R.without(g));
  if (!deterministic_) {
    const int place = place_of_[static_cast<std::size_t>(waypoint)];
    if (place < 0) return values_of(R)[static_cast<std::size_t>(waypoint)];
    require(R);
    return at(slot(R), place);
  }
  double best = kNoWay;
  R.for_each([&](int h) {
    const TaskSet rest = R.without(h);
    require(rest);
    best = std::min(best, static_cast<double>(legs_.from(waypoint, h) + solved(rest, h)));
  });
  return best;
}

const std::vector<float>& GoMdp::values_of(const TaskSet& R) {
  if (single_valid_ && values_set_ == R) return single_;
  R.for_each([&](int h) { require(R.without(h)); });
  solve_batch(&R, 1);
  single_.resize(map_.waypoints.size());
  for (std::size_t w = 0; w < single_.size(); ++w) single_[w] = values_[w * kLanes];
  values_set_ = R;
  single_valid_ = true;
  return single_;
}

int GoMdp::best_path(int waypoint, const TaskSet& given) {
  TaskSet R = given;
  if (const int g = legs_.goal_at(waypoint); g >= 0) R.erase(g);
  int best = -1;
  double least = kNoWay;
  if (R.empty() && legs_.home(waypoint) == 0.0F) return -1;
  for (const int p : outgoing_[static_cast<std::size_t>(waypoint)]) {
    const Path& path = map_.paths[static_cast<std::size_t>(p)];
    double sum = path.cost, stay = 0.0;
    for (const Outcome& o : path.outcomes) {
      if (o.waypoint == waypoint) stay += o.probability;
      else sum += o.probability * cost(o.waypoint, R);
    }
    if (stay < 1.0 && sum / (1.0 - stay) < least) least = sum / (1.0 - stay), best = p;
  }
  return best;
}

std::vector<int> GoMdp::order(int waypoint, const TaskSet& given) {
  std::vector<int> visits;
  TaskSet R = given;
  // On a deterministic map every step of the policy is downhill; with deviation, following the likeliest outcomes may
  // go in a circle (never seen); the rest is then taken nearest first.
  for (std::size_t step = 0; step < 4 * map_.waypoints.size() * (given.members().size() + 1); ++step) {
    if (const int g = legs_.goal_at(waypoint); g >= 0 && R.contains(g)) {
      visits.push_back(g);
      R.erase(g);
    }
    if (R.empty()) return visits;
    const int p = best_path(waypoint, R);
    if (p < 0) break;
    waypoint = map_.paths[static_cast<std::size_t>(p)].to;
  }
  while (!R.empty()) {
    int nearest = R.members().front();
    R.for_each([&](int g) {
      if (legs_.from(waypoint, g) < legs_.from(waypoint, nearest)) nearest = g;
    });
    visits.push_back(nearest);
    R.erase(nearest);
    waypoint = legs_.waypoint(nearest);
  }
  return visits;
}

void GoMdp::solve_all() {
  assert(legs_.goals() <= kMostForTable);
  if (complete_) return;
  const TaskSet all = TaskSet::first(legs_.goals());
  if (!deterministic_) {
    rows_.reserve((std::size_t{1} << legs_.goals()) * kept_.size());
    require(all);
    return;
  }
  const std::size_t sets = std::size_t{1} << legs_.goals();
  std::vector<float> none(rows_.begin(), rows_.begin() + static_cast<std::ptrdiff_t>(kept_.size()));
  rows_ = std::vector<float>(sets * kept_.size());
  std::copy(none.begin(), none.end(), rows_.begin());
  direct_ = {};
  complete_ = true;
  filled_ = sets;
  for (std::size_t R = 1; R < sets; ++R) fill_deterministic(TaskSet(R), static_cast<Slot>(R));
}

}  // namespace outrider::decision
