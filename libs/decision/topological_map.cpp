#include "decision/topological_map.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <queue>

namespace outrider::decision {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<std::string_view, kSemanticStates> kNames{"free-space", "one-obstacle", "dead-end", "corridor",
                                                               "funnel", "gate", "junction", "intersection"};

/// Waypoints from which some policy reaches `target` almost surely, and the paths that such a policy may use.
struct SureWays {
  std::vector<char> waypoint, path;
};

/// The usual double fixpoint: drop paths that may leave the set, then waypoints that no longer see the target.
SureWays sure_ways(const TopologicalMap& map, int target) {
  SureWays sure{std::vector<char>(map.waypoints.size(), 1), std::vector<char>(map.paths.size(), 1)};
  while (true) {
    for (std::size_t p = 0; p < map.paths.size(); ++p)
      for (const Outcome& o : map.paths[p].outcomes)
        if (!sure.waypoint[static_cast<std::size_t>(o.waypoint)]) sure.path[p] = 0;
    std::vector<char> reaches(map.waypoints.size(), 0);
    reaches[static_cast<std::size_t>(target)] = 1;
    for (bool grew = true; grew;) {
      grew = false;
      for (std::size_t p = 0; p < map.paths.size(); ++p) {
        const auto from = static_cast<std::size_t>(map.paths[p].from);
        if (!sure.path[p] || reaches[from]) continue;
        for (const Outcome& o : map.paths[p].outcomes)
          if (reaches[static_cast<std::size_t>(o.waypoint)]) reaches[from] = 1, grew = true;
      }
    }
    if (reaches == sure.waypoint) return sure;
    sure.waypoint = std::move(reaches);
  }
}

/// c_p + sum d_p(w') V(w') with the chance to stay where one is solved for.
double backup(const Path& path, const std::vector<double>& value) {
  double sum = path.cost, stay = 0.0;
  for (const Outcome& o : path.outcomes) {
    if (o.waypoint == path.from) stay += o.probability;
    else sum += o.probability * value[static_cast<std::size_t>(o.waypoint)];
  }
  return stay < 1.0 ? sum / (1.0 - stay) : kInfinity;
}

}  // namespace

std::string_view to_string(SemanticState state) { return kNames[static_cast<std::size_t>(state)]; }

std::optional<SemanticState> semantic_state(std::string_view name) {
  const auto it = std::find(kNames.begin(), kNames.end(), name);
  if (it == kNames.end()) return std::nullopt;
  return static_cast<SemanticState>(it - kNames.begin());
}

bool punctual(SemanticState state) {
  return state == SemanticState::kDeadEnd || state == SemanticState::kFunnel || state == SemanticState::kJunction ||
         state == SemanticState::kIntersection;
}

std::optional<int> TopologicalMap::find(std::string_view id) const {
  const auto it = std::find_if(waypoints.begin(), waypoints.end(), [&](const Waypoint& w) { return w.id == id; });
  if (it == waypoints.end()) return std::nullopt;
  return static_cast<int>(it - waypoints.begin());
}

std::vector<std::vector<int>> TopologicalMap::outgoing() const {
  std::vector<std::vector<int>> result(waypoints.size());
  for (std::size_t p = 0; p < paths.size(); ++p)
    result[static_cast<std::size_t>(paths[p].from)].push_back(static_cast<int>(p));
  return result;
}

bool TopologicalMap::deterministic() const {
  return std::all_of(paths.begin(), paths.end(), [](const Path& p) { return p.outcomes.size() == 1; });
}

Path certain_path(int from, int to, double cost) { return {from, to, {}, cost, {{to, 1.0}}, {}}; }

std::vector<double> costs_to(const TopologicalMap& map, int target) {
  std::vector<std::vector<std::pair<int, double>>> incoming(map.waypoints.size());  // (from, cost)
  for (const Path& p : map.paths)
    for (const Outcome& o : p.outcomes) incoming[static_cast<std::size_t>(o.waypoint)].emplace_back(p.from, p.cost);
  std::vector<double> cost(map.waypoints.size(), kInfinity);
  cost[static_cast<std::size_t>(target)] = 0.0;
  using Open = std::pair<double, int>;
  std::priority_queue<Open, std::vector<Open>, std::greater<>> open;
  open.emplace(0.0, target);
  while (!open.empty()) {
    const auto [c, w] = open.top();
    open.pop();
    if (c > cost[static_cast<std::size_t>(w)]) continue;
    for (const auto& [from, step] : incoming[static_cast<std::size_t>(w)]) {
      if (c + step >= cost[static_cast<std::size_t>(from)]) continue;
      cost[static_cast<std::size_t>(from)] = c + step;
      open.emplace(c + step, from);
    }
  }
  return cost;
}

std::vector<double> expected_costs_to(const TopologicalMap& map, int target) {
  constexpr double kResidual = 1e-9;
  std::vector<double> value = costs_to(map, target);
  if (map.deterministic()) return value;
  const SureWays sure = sure_ways(map, target);
  for (std::size_t w = 0; w < value.size(); ++w)
    if (!sure.waypoint[w]) value[w] = kInfinity;
  const auto outgoing = map.outgoing();
  std::vector<int> order;  // nearest first: news travel from the target
  for (std::size_t w = 0; w < value.size(); ++w)
    if (sure.waypoint[w] && static_cast<int>(w) != target) order.push_back(static_cast<int>(w));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return value[static_cast<std::size_t>(a)] < value[static_cast<std::size_t>(b)];
  });
  for (double worst = 1.0; worst > kResidual;) {
    worst = 0.0;
    for (const int w : order) {
      double best = kInfinity;
      for (const int p : outgoing[static_cast<std::size_t>(w)])
        if (sure.path[static_cast<std::size_t>(p)]) best = std::min(best, backup(map.paths[static_cast<std::size_t>(p)], value));
      double& v = value[static_cast<std::size_t>(w)];
      if (best > v) worst = std::max(worst, (best - v) / best);
      v = std::max(v, best);
    }
  }
  return value;
}

double diameter(const TopologicalMap& map) {
  double longest = 0.0;
  for (std::size_t w = 0; w < map.waypoints.size(); ++w)
    for (const double c : costs_to(map, static_cast<int>(w)))
      if (c < kInfinity) longest = std::max(longest, c);
  return longest;
}

}  // namespace outrider::decision
