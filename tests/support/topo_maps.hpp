#pragma once
// Random topological maps for tests.

#include <random>
#include <string>

#include "decision/topological_map.hpp"

namespace outrider::test {

/// `side` x `side` street corners 1 apart (jittered), all reachable from all, a share `missing` of the other streets
/// left out. Each path misses its target with probability `deviation`: half of that it stays, half it ends elsewhere.
inline decision::TopologicalMap random_streets(int side, double missing, double deviation, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  decision::TopologicalMap map;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      map.waypoints.push_back({std::to_string(y * side + x), {x + 0.4 * unit(), y + 0.4 * unit(), 0.0}, {}, -1});
  const auto street = [&](int a, int b) {
    const double cost = distance(map.waypoints[static_cast<std::size_t>(a)].pose.position(),
                                 map.waypoints[static_cast<std::size_t>(b)].pose.position());
    map.paths.push_back(decision::certain_path(a, b, cost));
    map.paths.push_back(decision::certain_path(b, a, cost));
  };
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) {
      const int at = y * side + x;
      if (x + 1 < side && (y == 0 || unit() >= missing)) street(at, at + 1);
      if (y + 1 < side) street(at, at + side);  // columns stay whole: everything is connected
    }
  if (deviation == 0.0) return map;
  const auto outgoing = map.outgoing();
  for (decision::Path& p : map.paths) {
    std::vector<int> others;
    for (const int q : outgoing[static_cast<std::size_t>(p.from)])
      if (map.paths[static_cast<std::size_t>(q)].to != p.to) others.push_back(map.paths[static_cast<std::size_t>(q)].to);
    p.outcomes = {{p.to, 1.0 - deviation}, {p.from, others.empty() ? deviation : deviation / 2}};
    for (const int w : others) p.outcomes.push_back({w, deviation / 2 / static_cast<double>(others.size())});
  }
  return map;
}

/// `n` different waypoints.
inline std::vector<int> random_waypoints(const decision::TopologicalMap& map, int n, std::mt19937_64& random) {
  std::vector<int> all(map.waypoints.size());
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) std::swap(all[i], all[i + random() % (all.size() - i)]);
  all.resize(static_cast<std::size_t>(n));
  return all;
}

}  // namespace outrider::test
