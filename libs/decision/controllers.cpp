#include "decision/controllers.hpp"

#include <algorithm>
#include <cassert>

namespace outrider::decision {

std::optional<double> ReachingController::heading(const LocalView& model, Point target, std::optional<double> last) const {
  const double aim = std::atan2(target.y, target.x);
  std::optional<double> best;
  for (const double share : {1.0, 0.5, 0.0}) {  // before the robot turns back the margin gives way; the body does not
    const auto h = free_heading(model, target, radius + share * margin, last);
    if (h && (!best || std::abs(wrap_angle(*h - aim)) < std::abs(wrap_angle(*best - aim)))) best = h;
    if (best && std::abs(wrap_angle(*best - aim)) < kPi / 2.0) break;
  }
  return best;
}

std::optional<double> ReachingController::free_heading(const LocalView& model, Point target, double clear,
                                                       std::optional<double> last) const {
  const double aim = std::atan2(target.y, target.x), reach = std::min(look_ahead, std::hypot(target.x, target.y));
  struct Blocked {
    double middle, half;
  };
  std::vector<Blocked> blocked;  // headings on which the disc would meet a point within reach
  for (const Obstacle& obstacle : model.obstacles)
    for (const Point p : obstacle.polygon) {
      const double d = std::hypot(p.x, p.y);
      if (d > reach + clear) continue;
      const double bearing = std::atan2(p.y, p.x);
      if (d <= clear) blocked.push_back({bearing, kPi / 2.0});  // too near: only away from it
      else blocked.push_back({bearing, std::min(kPi / 2.0, std::asin(clear / d))});
    }
  const auto is_free = [&](double h) {
    return std::none_of(blocked.begin(), blocked.end(), [&](const Blocked& b) { return std::abs(wrap_angle(h - b.middle)) < b.half - 1e-9; });
  };
  if (is_free(aim)) return aim;
  std::optional<double> best;
  double least = 1e300;
  for (const Blocked& b : blocked)
    for (const double side : {1.0, -1.0}) {  // left and right of it
      const double h = wrap_angle(b.middle + side * (b.half + 1e-6));
      const double deviation = std::abs(wrap_angle(h - aim)) + (last ? steady * std::abs(wrap_angle(h - *last)) : 0.0);
      if (deviation < least && is_free(h)) least = deviation, best = h;
    }
  return best;
}

std::optional<double> TopologicalController::heading(const LocalView& model, std::size_t exit, std::optional<double> last) const {
  assert(exit < model.exits.size());
  return reach.heading(model, model.exits[exit].middle, last);
}

std::optional<std::size_t> exit_towards(const LocalView& model, double bearing) {
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < model.exits.size(); ++k)
    if (!best || std::abs(wrap_angle(model.exits[k].bearing - bearing)) < std::abs(wrap_angle(model.exits[*best].bearing - bearing)))
      best = k;
  return best;
}

}  // namespace outrider::decision
