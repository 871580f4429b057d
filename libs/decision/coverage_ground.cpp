#include "decision/coverage_ground.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>

#include "world/ray.hpp"

namespace outrider::decision {
namespace {

constexpr std::array<Cell, 8> kDirections{{{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};
constexpr std::uint32_t kStraight = 5, kDiagonal = 7;  // lengths of steps
constexpr std::uint32_t kFar = std::numeric_limits<std::uint32_t>::max();

Cell neighbour(Cell c, std::size_t direction) {
  return {c.x + kDirections[direction].x, c.y + kDirections[direction].y};
}

std::size_t direction_of(int dx, int dy) {
  return static_cast<std::size_t>(std::find(kDirections.begin(), kDirections.end(), Cell{dx, dy}) -
                                  kDirections.begin());
}

/// Octile distance in units of a fifth of a block.
std::uint32_t octile(Cell a, Cell b) {
  const int dx = std::abs(a.x - b.x), dy = std::abs(a.y - b.y);
  return kStraight * static_cast<std::uint32_t>(std::max(dx, dy)) +
         (kDiagonal - kStraight) * static_cast<std::uint32_t>(std::min(dx, dy));
}

}  // namespace

CoverageGround::CoverageGround(const OccupancyGrid& map, const Grid<std::uint8_t>& drivable,
                               const Grid<std::uint8_t>& counts, int block)
    : map_(map),
      coarse_{map.geometry().resolution * block, map.geometry().origin, (map.width() + block - 1) / block,
              (map.height() + block - 1) / block},
      block_(block),
      center_(coarse_.size(), Cell{-1, -1}),
      edges_(coarse_.size(), 0),
      weights_(coarse_.size(), 0),
      distance_(coarse_.size(), kFar),
      toward_(coarse_.size()) {
  for (Node node = 0; node < nodes(); ++node) survey(node, drivable, counts);
  for (Node node = 0; node < nodes(); ++node) link(node, drivable);
}

double CoverageGround::step_m(Node a, Node b) const {
  const Cell ca = coarse_.cell_at(a), cb = coarse_.cell_at(b);
  return coarse_.resolution * (ca.x != cb.x && ca.y != cb.y ? std::numbers::sqrt2 : 1.0);
}

/// Where robots pass through the block, and what it weighs.
void CoverageGround::survey(Node node, const Grid<std::uint8_t>& drivable, const Grid<std::uint8_t>& counts) {
  const Cell low{coarse_.cell_at(node).x * block_, coarse_.cell_at(node).y * block_};
  int nearest = std::numeric_limits<int>::max();
  for (int y = low.y; y < std::min(low.y + block_, map_.height()); ++y)
    for (int x = low.x; x < std::min(low.x + block_, map_.width()); ++x) {
      const Cell c{x, y};
      weights_[node] += counts[c] != 0;
      const int dx = 2 * (x - low.x) + 1 - block_, dy = 2 * (y - low.y) + 1 - block_;
      if (!drivable[c] || dx * dx + dy * dy >= nearest) continue;
      nearest = dx * dx + dy * dy;
      center_[node] = c;
    }
}

/// A neighbour can be driven to when the straight line between the two cells that robots pass through is drivable.
void CoverageGround::link(Node node, const Grid<std::uint8_t>& mask) {
  if (!drivable(node)) return;
  const GridGeometry& fine = map_.geometry();
  for (std::size_t d = 0; d < kDirections.size(); ++d) {
    const Cell n = neighbour(coarse_.cell_at(node), d);
    if (!coarse_.contains(n) || center_[coarse_.index(n)].x < 0) continue;
    const auto other = static_cast<Node>(coarse_.index(n));
    const Point a = fine.center(center_[std::min(node, other)]), b = fine.center(center_[std::max(node, other)]);
    const double length = distance(a, b);
    bool clear = true;
    walk_ray(fine, a, (b.x - a.x) / length, (b.y - a.y) / length, length, [&](Cell c, double) {
      clear = mask[c] != 0;
      return clear;
    });
    if (clear) edges_[node] = static_cast<std::uint8_t>(edges_[node] | 1U << d);
  }
}

const CoverageGround::View& CoverageGround::view(Node node, double range) {
  std::vector<View>& views = views_.try_emplace(range, nodes()).first->second;
  if (views[node].empty()) views[node] = make_view(node, range);
  return views[node];
}

CoverageGround::View CoverageGround::make_view(Node node, double range) const {
  View view;
  if (!drivable(node)) return view;
  const Point eye = map_.geometry().center(center_[node]);
  const Cell c = coarse_.cell_at(node);
  const int reach = static_cast<int>(range / coarse_.resolution) + 1;
  const auto sees = [&](Cell block) {
    if (block == c) return true;
    const Point to = coarse_.center(block);
    const double away = distance(eye, to);
    if (away > range) return false;
    bool there = false;
    walk_ray(map_.geometry(), eye, (to.x - eye.x) / away, (to.y - eye.y) / away, away, [&](Cell cell, double) {
      if (map_[cell] == CellState::kOccupied) return false;
      there = cell.x / block_ == block.x && cell.y / block_ == block.y;
      return !there;
    });
    return there;
  };
  for (int y = std::max(0, c.y - reach); y <= std::min(coarse_.height - 1, c.y + reach); ++y)
    for (int x = std::max(0, c.x - reach); x <= std::min(coarse_.width - 1, c.x + reach); ++x) {
      if (!sees({x, y})) continue;
      const auto seen = static_cast<Node>(coarse_.index({x, y}));
      if (view.empty() || view.back().index != seen / 64) view.push_back({seen / 64, 0});
      view.back().bits |= std::uint64_t{1} << (seen % 64);
    }
  return view;
}

const CoverageGround::Leg& CoverageGround::leg(Node from, Node to) {
  const auto [entry, fresh] = legs_.try_emplace(static_cast<std::uint64_t>(from) << 32U | to);
  if (fresh && !straight(from, to, entry->second)) search(from, to, entry->second);
  return entry->second;
}

/// The digital line, when it can be driven: no way over neighbours is shorter.
bool CoverageGround::straight(Node from, Node to, Leg& leg) const {
  const Cell begin = coarse_.cell_at(from), end = coarse_.cell_at(to);
  const int dx = end.x - begin.x, dy = end.y - begin.y, n = std::max(std::abs(dx), std::abs(dy));
  const auto part = [n](int d, int k) { return static_cast<int>(std::lround(static_cast<double>(d) * k / n)); };
  Cell at = begin;
  for (int k = 1; k <= n; ++k) {
    const Cell next{begin.x + part(dx, k), begin.y + part(dy, k)};
    if (!open(static_cast<Node>(coarse_.index(at)), direction_of(next.x - at.x, next.y - at.y))) return false;
    at = next;
    leg.nodes.push_back(static_cast<Node>(coarse_.index(at)));
  }
  return leg.exists = true;
}

/// A*, from `to` until `from` is reached.
void CoverageGround::search(Node from, Node to, Leg& leg) {
  leg.nodes.clear();
  for (const Node node : touched_) distance_[node] = kFar;
  const Cell goal = coarse_.cell_at(from);
  const auto reach = [&](Node node, std::uint32_t there) {
    if (there >= distance_[node]) return false;
    distance_[node] = there;
    touched_.push_back(node);
    heap_.emplace_back(there + octile(coarse_.cell_at(node), goal), node);
    std::push_heap(heap_.begin(), heap_.end(), std::greater<>());
    return true;
  };
  touched_.clear();
  heap_.clear();
  reach(to, 0);
  while (!heap_.empty() && heap_.front().second != from) {
    std::pop_heap(heap_.begin(), heap_.end(), std::greater<>());
    const auto [estimate, node] = heap_.back();
    heap_.pop_back();
    const Cell c = coarse_.cell_at(node);
    if (estimate > distance_[node] + octile(c, goal)) continue;  // reached on a shorter way since
    for (std::size_t d = 0; d < kDirections.size(); ++d) {
      if (!open(node, d)) continue;
      const auto next = static_cast<Node>(coarse_.index(neighbour(c, d)));
      if (reach(next, distance_[node] + (d % 2 != 0 ? kDiagonal : kStraight))) toward_[next] = node;
    }
  }
  leg.exists = distance_[from] != kFar;
  for (Node at = from; leg.exists && at != to; leg.nodes.push_back(at)) at = toward_[at];
}

}  // namespace outrider::decision
