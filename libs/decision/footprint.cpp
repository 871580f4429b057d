#include "decision/footprint.hpp"

#include <algorithm>

#include "world/ray.hpp"

namespace outrider::decision {

Footprint::Footprint(double range, const GridGeometry& geometry)
    : reach_(static_cast<int>(range / geometry.resolution) + 2) {
  const double resolution = geometry.resolution;
  constexpr int kFewest = 16, kMost = 48;
  const int n = std::clamp(static_cast<int>(std::ceil(2.0 * kPi * range / resolution)), kFewest, kMost);
  const double wedge = 2.0 * kPi / n;
  const GridGeometry local{resolution, {-(reach_ + 0.5) * resolution, -(reach_ + 0.5) * resolution}, 2 * reach_ + 1,
                           2 * reach_ + 1};
  for (int i = 0; i < n; ++i) {
    std::vector<Step> ray;
    std::vector<double> entry;
    const double angle = (i + 0.5) * wedge;
    walk_ray(local, {0.0, 0.0}, std::cos(angle), std::sin(angle), range, [&](Cell c, double t) {
      const Cell offset{c.x - reach_, c.y - reach_};
      ray.push_back({offset, static_cast<std::ptrdiff_t>(offset.y) * geometry.width + offset.x, 0.0});
      entry.push_back(t);
      return true;
    });
    entry.push_back(range);
    for (std::size_t k = 0; k < ray.size(); ++k)
      ray[k].area = 0.5 * wedge * (entry[k + 1] * entry[k + 1] - entry[k] * entry[k]);
    rays_.push_back(std::move(ray));
  }
}

template <class Counts>
double Footprint::sum(const OccupancyGrid& map, Cell from, Counts&& counts) const {
  const bool inside = map.contains({from.x - reach_, from.y - reach_}) && map.contains({from.x + reach_, from.y + reach_});
  const CellState* center = map.data().data() + map.geometry().index(from);
  double area = 0.0;
  for (const auto& ray : rays_) {
    for (const Step& step : ray) {
      if (!inside && !map.contains({from.x + step.offset.x, from.y + step.offset.y})) break;
      const CellState state = center[step.index];
      if (state == CellState::kOccupied) break;
      if (counts(state)) area += step.area;
    }
  }
  return area;
}

double Footprint::unseen_area(const OccupancyGrid& map, Cell from) const {
  return sum(map, from, [](CellState state) { return state == CellState::kUnknown; });
}

double Footprint::area(const OccupancyGrid& map, Cell from) const {
  return sum(map, from, [](CellState) { return true; });
}

}  // namespace outrider::decision
