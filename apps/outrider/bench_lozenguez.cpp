#include "bench_lozenguez.hpp"

#include "decision/grid_topology.hpp"
#include "explorer/mission.hpp"
#include "sim/world.hpp"

namespace outrider::app {

std::shared_ptr<const decision::TopologicalMap> lozenguez_map(const std::string& world, double longest_m) {
  const sim::World w = sim::embedded_world(world);
  return std::make_shared<decision::TopologicalMap>(decision::topology_of(
      explorer::solid_map(w.map), {.radius = w.team.empty() ? 0.2 : w.team[0].radius, .longest_m = longest_m}));
}

decision::TopologicalMap with_deviation(decision::TopologicalMap map, double deviation) {
  const auto outgoing = map.outgoing();
  for (decision::Path& p : map.paths) {
    std::vector<int> others;
    for (const int q : outgoing[static_cast<std::size_t>(p.from)])
      if (const int to = map.paths[static_cast<std::size_t>(q)].to; to != p.to) others.push_back(to);
    p.outcomes = {{p.to, 1.0 - deviation}, {p.from, others.empty() ? deviation : deviation / 2.0}};
    for (const int w : others) p.outcomes.push_back({w, deviation / 2.0 / static_cast<double>(others.size())});
  }
  return map;
}

}  // namespace outrider::app
