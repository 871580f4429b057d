#include "decision/swept_disc.hpp"

#include <algorithm>

namespace outrider::decision {
namespace {

constexpr double kTouch = 1e-9;  // [m]

double to_segment(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double s = length2 > 0.0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0.0;
  return distance(p, {a.x + s * dx, a.y + s * dy});
}

struct Box {
  double left, bottom, right, top;
  double to(Point p) const {
    return std::hypot(std::max({left - p.x, 0.0, p.x - right}), std::max({bottom - p.y, 0.0, p.y - top}));
  }
  /// Does the segment pass through the box? Liang and Barsky's clipping.
  bool meets(Point a, Point b) const {
    double begin = 0.0, end = 1.0;
    const auto clip = [&](double from, double step, double low, double high) {
      if (step == 0.0) return from >= low && from <= high;
      const double s = (low - from) / step, t = (high - from) / step;
      begin = std::max(begin, std::min(s, t));
      end = std::min(end, std::max(s, t));
      return begin <= end;
    };
    return clip(a.x, b.x - a.x, left, right) && clip(a.y, b.y - a.y, bottom, top);
  }
  /// Distance of two convex shapes: zero when they meet, else between a corner and the other shape.
  double to(Point a, Point b) const {
    if (meets(a, b)) return 0.0;
    return std::min({to(a), to(b), to_segment({left, bottom}, a, b), to_segment({right, bottom}, a, b),
                     to_segment({left, top}, a, b), to_segment({right, top}, a, b)});
  }
};

}  // namespace

bool sweep_clear(const OccupancyGrid& map, Point a, Point b, double radius) {
  const auto& g = map.geometry();
  const Cell low = g.cell_of({std::min(a.x, b.x) - radius, std::min(a.y, b.y) - radius});
  const Cell high = g.cell_of({std::max(a.x, b.x) + radius, std::max(a.y, b.y) + radius});
  for (int y = low.y; y <= high.y; ++y)
    for (int x = low.x; x <= high.x; ++x) {
      if (g.contains({x, y}) && map[Cell{x, y}] == CellState::kFree) continue;
      const Point c = g.center({x, y});
      const double half = g.resolution / 2.0;
      if (Box{c.x - half, c.y - half, c.x + half, c.y + half}.to(a, b) < radius - kTouch) return false;
    }
  return true;
}

}  // namespace outrider::decision
