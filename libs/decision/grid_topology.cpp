#include "decision/grid_topology.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>

#include "decision/passability.hpp"
#include "decision/skeleton.hpp"
#include "decision/swept_disc.hpp"
#include "world/error.hpp"

namespace outrider::decision {
namespace {

constexpr double kLook = 1.0;         // [m] along a path to where its bearing is taken
constexpr double kLeastAngle = 0.35;  // [rad] between exits that can be told apart

class Builder {
 public:
  Builder(const OccupancyGrid& map, const GridTopologyOptions& options)
      : map_(map), options_(options), mask_(strict_mask(map, options.radius)), skeleton_(skeleton_of(map, mask_)) {
    if (skeleton_.nodes.empty())
      throw InputError(fmt::format("no room on the map for a robot of radius {:g} m", options.radius));
  }

  TopologicalMap build() {
    split_ways();
    add_waypoints();
    for (const SkeletonEdge& e : skeleton_.edges) add_paths(e);
    orient();
    return std::move(result_);
  }

 private:
  /// passable_mask() where all that is not known free is a wall, and the edge of the map too.
  static Grid<std::uint8_t> strict_mask(const OccupancyGrid& map, double radius) {
    GridGeometry wider = map.geometry();
    wider.width += 2, wider.height += 2;
    OccupancyGrid solid(wider, CellState::kOccupied);
    for (int y = 0; y < map.height(); ++y)
      for (int x = 0; x < map.width(); ++x)
        if (map[Cell{x, y}] == CellState::kFree) solid[Cell{x + 1, y + 1}] = CellState::kFree;
    const Grid<std::uint8_t> inner = passable_mask(solid, radius);
    Grid<std::uint8_t> mask(map.geometry());
    for (int y = 0; y < map.height(); ++y)
      for (int x = 0; x < map.width(); ++x) mask[Cell{x, y}] = inner[Cell{x + 1, y + 1}];
    return mask;
  }

  double clearance(Cell c) const { return skeleton_.clearance[c]; }
  Point at(Cell c) const { return map_.geometry().center(c); }

  /// Cuts ways at funnels, loops and doubles in the middle (two waypoints have one way between them), and long ones.
  void split_ways() {
    for (std::size_t e = 0; e < skeleton_.edges.size(); ++e)
      while (const auto k = funnel(skeleton_.edges[e].cells)) split(e, *k, SemanticState::kFunnel);
    std::map<std::pair<int, int>, int> seen;
    for (std::size_t e = 0; e < skeleton_.edges.size(); ++e) {
      const SkeletonEdge& x = skeleton_.edges[e];
      const std::size_t half = x.cells.size() / 2;
      if (x.a == x.b && x.cells.size() > 3) {
        split(e, half, SemanticState::kCorridor);
        split(e, skeleton_.edges[e].cells.size() / 2, SemanticState::kCorridor);
      } else if (seen[std::minmax(x.a, x.b)]++ > 0 && x.cells.size() > 2) {
        split(e, half, SemanticState::kCorridor);
      } else if (options_.longest_m > 0.0 && x.length > options_.longest_m && x.cells.size() > 2) {
        --seen[std::minmax(x.a, x.b)];
        split(e--, half, SemanticState::kCorridor);
      }
    }
  }

  /// The narrowest place of a way, when there is more room on both sides of it.
  std::optional<std::size_t> funnel(const std::vector<Cell>& cells) const {
    if (cells.size() < 5) return std::nullopt;
    std::size_t narrow = 1;
    for (std::size_t k = 1; k + 1 < cells.size(); ++k)
      if (clearance(cells[k]) < clearance(cells[narrow])) narrow = k;
    double before = 0.0, after = 0.0;
    for (std::size_t k = 0; k < cells.size(); ++k) (k < narrow ? before : after) = std::max(k < narrow ? before : after, clearance(cells[k]));
    const bool room = clearance(cells[narrow]) < options_.funnel_share * std::min(before, after);
    // The middle of a long narrow piece.
    std::size_t last = narrow;
    const double half_cell = 0.5 * map_.geometry().resolution;
    while (last + 2 < cells.size() && clearance(cells[last + 1]) < clearance(cells[narrow]) + half_cell) ++last;
    return room ? std::optional((narrow + last) / 2) : std::nullopt;
  }

  /// Cuts edge e at its k-th cell; the second half becomes a new edge.
  void split(std::size_t e, std::size_t k, SemanticState state) {
    const int n = static_cast<int>(skeleton_.nodes.size());
    SkeletonEdge& x = skeleton_.edges[e];
    const auto cut = x.cells.begin() + static_cast<std::ptrdiff_t>(k);
    SkeletonEdge rest{n, x.b, {cut, x.cells.end()}, 0.0};
    x.cells.erase(cut + 1, x.cells.end());
    x.b = n;
    x.length /= 2.0;
    rest.length = x.length;
    skeleton_.nodes.push_back({x.cells.back(), clearance(x.cells.back()), {}});
    states_[n] = state;
    skeleton_.edges.push_back(std::move(rest));
  }

  void add_waypoints() {
    std::vector<int> degree(skeleton_.nodes.size(), 0);
    for (const SkeletonEdge& e : skeleton_.edges) ++degree[static_cast<std::size_t>(e.a)], ++degree[static_cast<std::size_t>(e.b)];
    std::vector<std::size_t> order(skeleton_.nodes.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const Cell p = skeleton_.nodes[a].cell, q = skeleton_.nodes[b].cell;
      return std::pair(p.y, p.x) < std::pair(q.y, q.x);
    });
    number_.resize(order.size());
    for (const std::size_t n : order) {
      number_[n] = static_cast<int>(result_.waypoints.size());
      const Point p = at(skeleton_.nodes[n].cell);
      const int id = number_[n] + 1;
      result_.waypoints.push_back({fmt::format("w{}", id), {p.x, p.y, 0.0}, state_of(static_cast<int>(n), degree[n]), id});
    }
  }

  SemanticState state_of(int node, int degree) const {
    if (const auto it = states_.find(node); it != states_.end()) return it->second;
    if (degree <= 1) return degree == 0 ? SemanticState::kFreeSpace : SemanticState::kDeadEnd;
    if (degree == 2) return SemanticState::kCorridor;
    return degree == 3 ? SemanticState::kJunction : SemanticState::kIntersection;
  }

  /// The cells as points; where a diagonal step would cut a corner, the free cell beside it comes between.
  std::vector<Point> points(const std::vector<Cell>& cells) const {
    std::vector<Point> way{at(cells[0])};
    for (std::size_t k = 1; k < cells.size(); ++k) {
      const Cell a = cells[k - 1], b = cells[k];
      if (!step_allowed(mask_, a, b)) {
        const Cell side = mask_[Cell{a.x, b.y}] ? Cell{a.x, b.y} : Cell{b.x, a.y};
        if (!mask_[side]) return {};
        way.push_back(at(side));
      }
      way.push_back(at(b));
    }
    return way;
  }

  /// As few straight pieces as keep half of the room that the way has around it.
  std::vector<Point> straightened(const std::vector<Point>& way) const {
    std::vector<Point> result{way.front()};
    for (std::size_t from = 0; from + 1 < way.size();) {
      std::size_t best = from + 1;
      double room = clearance(map_.geometry().cell_of(way[from]));
      for (std::size_t to = from + 1; to < way.size(); ++to) {
        room = std::min(room, clearance(map_.geometry().cell_of(way[to])));
        const double keep = options_.radius + 0.5 * std::max(0.0, room - options_.radius);
        if (to > from + 1 && sweep_clear(map_, way[from], way[to], keep)) best = to;
        else if (to > best + 10) break;  // it has turned away
      }
      result.push_back(way[best]);
      from = best;
    }
    return result;
  }

  void add_paths(const SkeletonEdge& e) {
    const std::vector<Point> raw = points(e.cells);
    if (raw.size() < 2 || e.a == e.b) return;
    const std::vector<Point> way = straightened(raw);
    double length = 0.0;
    for (std::size_t k = 1; k < way.size(); ++k) length += distance(way[k - 1], way[k]);
    Path path = certain_path(number_[static_cast<std::size_t>(e.a)], number_[static_cast<std::size_t>(e.b)], length);
    path.via.assign(way.begin() + 1, way.end() - 1);
    Path back = certain_path(path.to, path.from, length);
    back.via.assign(path.via.rbegin(), path.via.rend());
    result_.paths.push_back(std::move(path));
    result_.paths.push_back(std::move(back));
  }

  /// Every waypoint looks away from the widest gap between its ways; ways that can be told apart get their exit.
  void orient() {
    const auto outgoing = result_.outgoing();
    for (std::size_t w = 0; w < outgoing.size(); ++w) {
      if (outgoing[w].empty()) continue;
      const std::vector<double> bearings = exit_bearings(result_, static_cast<int>(w), outgoing[w]);
      std::vector<double> sorted = bearings;
      std::sort(sorted.begin(), sorted.end());
      double widest = 2.0 * kPi + sorted.front() - sorted.back(), behind = sorted.back() + widest / 2.0, least = widest;
      for (std::size_t k = 1; k < sorted.size(); ++k) {
        const double gap = sorted[k] - sorted[k - 1];
        least = std::min(least, gap);
        if (gap > widest) widest = gap, behind = sorted[k - 1] + gap / 2.0;
      }
      result_.waypoints[w].pose.theta = wrap_angle(behind + kPi);
      if (least < kLeastAngle) continue;
      const std::vector<int> exits = left_to_right(bearings, result_.waypoints[w].pose.theta);
      for (std::size_t k = 0; k < exits.size(); ++k)
        result_.paths[static_cast<std::size_t>(outgoing[w][k])].rule = {SupervisionRule::Kind::kExit, exits[k]};
    }
  }

  const OccupancyGrid& map_;
  const GridTopologyOptions& options_;
  Grid<std::uint8_t> mask_;
  Skeleton skeleton_;
  std::map<int, SemanticState> states_;  // of nodes that were put into ways
  std::vector<int> number_;              // node -> waypoint
  TopologicalMap result_;
};

}  // namespace

std::vector<double> exit_bearings(const TopologicalMap& map, int w, const std::vector<int>& outgoing) {
  std::vector<double> bearings;
  for (const int p : outgoing) {
    const Path& path = map.paths[static_cast<std::size_t>(p)];
    const Point from = map.waypoints[static_cast<std::size_t>(w)].pose.position();
    std::vector<Point> way = path.via;
    way.push_back(map.waypoints[static_cast<std::size_t>(path.to)].pose.position());
    Point last = from, look = way.back();
    double rest = kLook;
    for (const Point next : way) {
      const double d = distance(last, next);
      if (d >= rest) {
        look = {last.x + rest / d * (next.x - last.x), last.y + rest / d * (next.y - last.y)};
        break;
      }
      rest -= d;
      last = next;
    }
    bearings.push_back(std::atan2(look.y - from.y, look.x - from.x));
  }
  return bearings;
}

std::vector<int> left_to_right(const std::vector<double>& bearings, double theta) {
  std::vector<int> order;
  for (const double b : bearings)
    order.push_back(static_cast<int>(std::count_if(bearings.begin(), bearings.end(), [&](double other) {
      return wrap_angle(other - theta) > wrap_angle(b - theta);
    })));
  return order;
}

TopologicalMap topology_of(const OccupancyGrid& map, const GridTopologyOptions& options) {
  return Builder(map, options).build();
}

}  // namespace outrider::decision
