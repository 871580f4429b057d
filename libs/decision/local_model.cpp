#include "decision/local_model.hpp"

#include <algorithm>

namespace outrider::decision {
namespace {

struct Hit {
  double angle;
  Point at;
};

double gap_angle(const Hit& from, const Hit& to) {
  const double turn = std::fmod(to.angle - from.angle + 4.0 * kPi, 2.0 * kPi);
  return turn == 0.0 ? 2.0 * kPi : turn;
}

}  // namespace

SemanticState state_of(std::size_t obstacles, const std::vector<Exit>& exits) {
  const auto open = std::count_if(exits.begin(), exits.end(), [](const Exit& e) { return e.open; });
  if (obstacles == 0) return SemanticState::kFreeSpace;
  if (exits.size() <= 1) return open == 1 ? SemanticState::kOneObstacle : SemanticState::kDeadEnd;
  if (exits.size() == 2)
    return open == 0 ? SemanticState::kCorridor : open == 1 ? SemanticState::kFunnel : SemanticState::kGate;
  return exits.size() == 3 ? SemanticState::kJunction : SemanticState::kIntersection;
}

LocalView LocalInterpreter::operator()(const LaserScan& scan) const {
  std::vector<Hit> hits;
  for (std::size_t b = 0; b < scan.ranges.size(); ++b)
    if (const double r = scan.ranges[b]; scan.valid(b) && r <= range) {
      const double angle = scan.angle(b) + scan.T_robot_sensor.theta;
      hits.push_back({angle, {r * std::cos(angle), r * std::sin(angle)}});
    }
  LocalView model;
  if (hits.empty()) return model;
  // Gaps between neighbours that the robot fits through. A gap too wide to be narrow part of a wall seen from the side
  // has beams without a hit in it, or is a step in depth; both are ways.
  std::vector<std::size_t> gaps;  // behind hit k
  for (std::size_t k = 0; k < hits.size(); ++k) {
    const Hit& next = hits[(k + 1) % hits.size()];
    if (distance(hits[k].at, next.at) > passage || gap_angle(hits[k], next) > open_angle) gaps.push_back(k);
  }
  for (const std::size_t k : gaps) {
    const Hit &from = hits[k], &to = hits[(k + 1) % hits.size()];
    const double turn = gap_angle(from, to);
    Exit exit;
    exit.open = turn > open_angle;
    if (exit.open) {
      exit.bearing = wrap_angle(from.angle + turn / 2.0);
      exit.middle = {0.5 * range * std::cos(exit.bearing), 0.5 * range * std::sin(exit.bearing)};
      exit.width = range;
    } else {
      exit.middle = {(from.at.x + to.at.x) / 2.0, (from.at.y + to.at.y) / 2.0};
      exit.bearing = std::atan2(exit.middle.y, exit.middle.x);
      exit.width = distance(from.at, to.at);
    }
    model.exits.push_back(exit);
  }
  std::sort(model.exits.begin(), model.exits.end(), [](const Exit& a, const Exit& b) { return a.bearing > b.bearing; });
  // Obstacles are what lies between two gaps.
  const std::size_t first = gaps.empty() ? 0 : (gaps[0] + 1) % hits.size();
  model.obstacles.emplace_back();
  for (std::size_t n = 0; n < hits.size(); ++n) {
    const std::size_t k = (first + n) % hits.size();
    model.obstacles.back().polygon.push_back(hits[k].at);
    if (n + 1 < hits.size() && std::binary_search(gaps.begin(), gaps.end(), k)) model.obstacles.emplace_back();
  }
  model.state = state_of(model.obstacles.size(), model.exits);
  return model;
}

}  // namespace outrider::decision
