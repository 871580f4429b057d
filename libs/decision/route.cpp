#include "decision/route.hpp"

#include <limits>

namespace outrider::decision {

std::vector<int> route(const TopologicalMap& map, int from, int to) {
  const std::vector<double> cost = costs_to(map, to);
  const auto outgoing = map.outgoing();
  std::vector<int> paths;
  for (int at = from; at != to && paths.size() < map.waypoints.size();) {
    int best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (const int p : outgoing[static_cast<std::size_t>(at)]) {
      const Path& path = map.paths[static_cast<std::size_t>(p)];
      if (const double c = path.cost + cost[static_cast<std::size_t>(path.to)]; c < least) least = c, best = p;
    }
    if (best < 0) return {};
    paths.push_back(best);
    at = map.paths[static_cast<std::size_t>(best)].to;
  }
  return paths;
}

std::vector<Point> route_points(const TopologicalMap& map, int from, const std::vector<int>& paths) {
  std::vector<Point> points{map.waypoints[static_cast<std::size_t>(from)].pose.position()};
  for (const int p : paths) {
    const Path& path = map.paths[static_cast<std::size_t>(p)];
    points.insert(points.end(), path.via.begin(), path.via.end());
    points.push_back(map.waypoints[static_cast<std::size_t>(path.to)].pose.position());
  }
  return points;
}

}  // namespace outrider::decision
