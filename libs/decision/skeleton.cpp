#include "decision/skeleton.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <opencv2/imgproc.hpp>
#include <queue>
#include <tuple>

namespace outrider::decision {
namespace {

// Around a cell, counter-clockwise from the east; odd ones are diagonal.
constexpr std::array<Cell, 8> kAround{Cell{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};

Cell step(Cell c, std::size_t k) { return {c.x + kAround[k].x, c.y + kAround[k].y}; }

std::array<bool, 8> around(const Grid<std::uint8_t>& grid, Cell c) {
  std::array<bool, 8> set{};
  for (std::size_t k = 0; k < 8; ++k) set[k] = grid.contains(step(c, k)) && grid[step(c, k)] != 0;
  return set;
}

/// Yokoi's connectivity number for 8-connected sets: 1 = removing the cell joins and parts nothing.
bool simple(const std::array<bool, 8>& n) {
  int number = 0;
  for (std::size_t k = 0; k < 8; k += 2) number += !n[k] && (n[k + 1] || n[(k + 2) % 8]) ? 1 : 0;
  return number == 1;
}

/// The end of a line, one or two cells wide: all its neighbours are one, or two that touch. Would it go, the line would
/// be eaten up from there.
bool ends(const std::array<bool, 8>& n) {
  const auto count = std::count(n.begin(), n.end(), true);
  if (count > 2) return false;
  for (std::size_t k = 0; count == 2 && k < 8; ++k)
    if (n[k] && n[(k + 1) % 8]) return true;
  return count < 2;
}

/// Ways may step diagonally only where the robot can: cells that touch at a corner alone are parted.
Grid<std::uint8_t> largest_part(const Grid<std::uint8_t>& mask) {
  Grid<std::uint8_t> best(mask.geometry()), seen(mask.geometry());
  std::size_t most = 0;
  for (std::size_t i = 0; i < mask.size(); ++i) {
    if (!mask[i] || seen[i]) continue;
    std::vector<Cell> part{mask.geometry().cell_at(i)};
    seen[i] = 1;
    for (std::size_t k = 0; k < part.size(); ++k)
      for (std::size_t d = 0; d < 8; d += 2)
        if (const Cell n = step(part[k], d); mask.contains(n) && mask[n] && !seen[n]) seen[n] = 1, part.push_back(n);
    if (part.size() <= most) continue;
    most = part.size();
    best = Grid<std::uint8_t>(mask.geometry());
    for (const Cell c : part) best[c] = 1;
  }
  return best;
}

/// From the cells of a thinned mask to nodes and edges.
class Tracer {
 public:
  Tracer(const Grid<std::uint8_t>& lines, Skeleton& out)
      : lines_(lines), out_(out), node_(lines.geometry(), -1), used_(lines.geometry()) {}

  void run() {
    for_lines([&](Cell c, int neighbours) {
      if (neighbours != 2 && node_[c] < 0) add_node(c);
    });
    trace_all();
    for_lines([&](Cell c, int) {  // rings without any node
      if (node_[c] >= 0 || used_[c]) return;
      add_node(c);
      trace_all();
    });
  }

 private:
  template <class Visit>
  void for_lines(Visit&& visit) {
    for (std::size_t i = 0; i < lines_.size(); ++i)
      if (lines_[i]) {
        const Cell c = lines_.geometry().cell_at(i);
        visit(c, degree(c));
      }
  }
  int degree(Cell c) const {
    const auto n = around(lines_, c);
    return static_cast<int>(std::count(n.begin(), n.end(), true));
  }

  /// A cell where lines meet, with the others of its kind that touch it.
  void add_node(Cell first) {
    const int id = static_cast<int>(out_.nodes.size());
    std::vector<Cell> cluster{first};
    node_[first] = id;
    for (std::size_t k = 0; degree(first) > 2 && k < cluster.size(); ++k)
      for (std::size_t d = 0; d < 8; ++d)
        if (const Cell n = step(cluster[k], d); lines_.contains(n) && lines_[n] && node_[n] < 0 && degree(n) > 2)
          node_[n] = id, cluster.push_back(n);
    const Cell middle = *std::max_element(cluster.begin(), cluster.end(), [&](Cell a, Cell b) {
      return out_.clearance[a] < out_.clearance[b];
    });
    out_.nodes.push_back({middle, out_.clearance[middle], {}});
    clusters_.push_back(std::move(cluster));
  }

  void trace_all() {
    for (; traced_ < clusters_.size(); ++traced_)
      for (const Cell c : clusters_[traced_])
        for (std::size_t d = 0; d < 8; ++d) {
          const Cell n = step(c, d);
          if (!lines_.contains(n) || !lines_[n] || used_[n]) continue;
          if (node_[n] < 0) trace(static_cast<int>(traced_), c, n);
          else if (node_[n] > static_cast<int>(traced_)) add_edge(static_cast<int>(traced_), c, {}, n);
        }
  }

  void trace(int from, Cell begin, Cell next) {
    std::vector<Cell> chain{next};
    used_[next] = 1;
    Cell before = begin;
    while (true) {
      const Cell at = chain.back();
      std::optional<Cell> on;
      for (std::size_t d = 0; d < 8; ++d) {
        const Cell n = step(at, d);
        if (n == before || !lines_.contains(n) || !lines_[n]) continue;
        if (node_[n] == from && chain.size() < 2) continue;  // another cell of the cluster we come from
        if (node_[n] >= 0) {
          add_edge(from, begin, std::move(chain), n);
          return;
        }
        if (!used_[n]) on = n;
      }
      if (!on) return;  // never: every line ends in a node
      used_[*on] = 1;
      before = at;
      chain.push_back(*on);
    }
  }

  /// The way from a cluster's middle to one of its cells, both included.
  std::vector<Cell> inside(int node, Cell to) const {
    const auto& cluster = clusters_[static_cast<std::size_t>(node)];
    const Cell middle = out_.nodes[static_cast<std::size_t>(node)].cell;
    std::vector<std::pair<Cell, int>> queue{{middle, -1}};  // cell, index of the one before
    for (std::size_t k = 0;; ++k) {
      if (queue[k].first == to) {
        std::vector<Cell> way;
        for (int i = static_cast<int>(k); i >= 0; i = queue[static_cast<std::size_t>(i)].second)
          way.push_back(queue[static_cast<std::size_t>(i)].first);
        std::reverse(way.begin(), way.end());
        return way;
      }
      for (const Cell n : cluster) {
        const bool adjacent = std::abs(n.x - queue[k].first.x) <= 1 && std::abs(n.y - queue[k].first.y) <= 1;
        const bool known = std::any_of(queue.begin(), queue.end(), [&](const auto& q) { return q.first == n; });
        if (adjacent && !known) queue.emplace_back(n, static_cast<int>(k));
      }
    }
  }

  void add_edge(int from, Cell begin, std::vector<Cell> chain, Cell end) {
    SkeletonEdge edge{from, node_[end], inside(from, begin), 0.0};
    edge.cells.insert(edge.cells.end(), chain.begin(), chain.end());
    std::vector<Cell> tail = inside(edge.b, end);
    edge.cells.insert(edge.cells.end(), tail.rbegin(), tail.rend());
    out_.edges.push_back(std::move(edge));
  }

  const Grid<std::uint8_t>& lines_;
  Skeleton& out_;
  Grid<int> node_;
  Grid<std::uint8_t> used_;
  std::vector<std::vector<Cell>> clusters_;
  std::size_t traced_ = 0;
};

/// Removes what is no choice of way.
class Cleaner {
 public:
  explicit Cleaner(Skeleton& s) : s_(s), alive_(s.edges.size(), 1) {
    for (SkeletonEdge& e : s_.edges) measure(e);
    link();
  }

  void run() {
    bool changed = true;
    while (changed) {
      changed = prune();
      changed = contract() || changed;
      changed = join() || changed;
      link();
    }
    compact();
  }

 private:
  void measure(SkeletonEdge& e) const {
    e.length = 0.0;
    const auto& g = s_.clearance.geometry();
    for (std::size_t k = 1; k < e.cells.size(); ++k) e.length += distance(g.center(e.cells[k - 1]), g.center(e.cells[k]));
  }
  SkeletonNode& node(int n) { return s_.nodes[static_cast<std::size_t>(n)]; }
  SkeletonEdge& edge(int e) { return s_.edges[static_cast<std::size_t>(e)]; }

  void link() {
    for (auto& n : s_.nodes) n.edges.clear();
    for (std::size_t e = 0; e < s_.edges.size(); ++e)
      if (alive_[e]) {
        node(s_.edges[e].a).edges.push_back(static_cast<int>(e));
        node(s_.edges[e].b).edges.push_back(static_cast<int>(e));
      }
  }

  /// Cuts all spurs at once: dead ends no deeper than the place they leave is wide, as in the corners of a room.
  bool prune() {
    constexpr double kDepth = 1.6;  // a corner's spur is sqrt 2 clearances long
    std::vector<std::size_t> spurs;
    for (std::size_t e = 0; e < s_.edges.size(); ++e) {
      if (!alive_[e]) continue;
      const SkeletonEdge& x = s_.edges[e];
      const bool end_a = node(x.a).edges.size() == 1, end_b = node(x.b).edges.size() == 1;
      if (end_a == end_b || node(end_a ? x.b : x.a).edges.size() < 3) continue;
      if (x.length < kDepth * node(end_a ? x.b : x.a).clearance) spurs.push_back(e);
    }
    for (const std::size_t e : spurs) alive_[e] = 0;
    link();
    return !spurs.empty();
  }

  /// Meeting places inside each other's free disc are one; loops within it are none.
  bool contract() {
    bool any = false;
    for (std::size_t e = 0; e < s_.edges.size(); ++e) {
      if (!alive_[e]) continue;
      const SkeletonEdge x = s_.edges[e];
      const double near = std::max(node(x.a).clearance, node(x.b).clearance);
      if (x.a == x.b) {
        if (x.length < 2.0 * std::numbers::pi * near) alive_[e] = 0, any = true;
        continue;
      }
      if (x.length >= near || node(x.a).edges.size() < 3 || node(x.b).edges.size() < 3) continue;
      alive_[e] = 0;
      any = true;
      const bool keep_a = node(x.a).clearance >= node(x.b).clearance;
      std::vector<Cell> way = x.cells;  // from the kept node to the other
      if (!keep_a) std::reverse(way.begin(), way.end());
      redirect(keep_a ? x.b : x.a, keep_a ? x.a : x.b, way);
      link();
    }
    link();
    return any;
  }

  /// Edges of `gone` begin at `kept` from now on.
  void redirect(int gone, int kept, const std::vector<Cell>& way) {
    for (const int e : node(gone).edges) {
      if (!alive_[static_cast<std::size_t>(e)]) continue;
      SkeletonEdge& x = edge(e);
      if (x.a == gone) {
        x.cells.insert(x.cells.begin(), way.begin(), way.end() - 1);
        x.a = kept;
      }
      if (x.b == gone) {
        x.cells.insert(x.cells.end(), way.rbegin() + 1, way.rend());
        x.b = kept;
      }
      measure(x);
    }
  }

  /// Where only two ways are left there is nothing to decide: they become one.
  bool join() {
    bool any = false;
    for (std::size_t n = 0; n < s_.nodes.size(); ++n) {
      const auto edges = s_.nodes[n].edges;
      if (edges.size() != 2 || edges[0] == edges[1]) continue;
      SkeletonEdge &x = edge(edges[0]), &y = edge(edges[1]);
      if (x.b != static_cast<int>(n)) std::swap(x.a, x.b), std::reverse(x.cells.begin(), x.cells.end());
      if (y.a != static_cast<int>(n)) std::swap(y.a, y.b), std::reverse(y.cells.begin(), y.cells.end());
      x.cells.insert(x.cells.end(), y.cells.begin() + 1, y.cells.end());
      x.b = y.b;
      measure(x);
      alive_[static_cast<std::size_t>(edges[1])] = 0;
      any = true;
      link();
    }
    return any;
  }

  void compact() {
    std::vector<SkeletonNode> nodes;
    std::vector<SkeletonEdge> edges;
    std::vector<int> number(s_.nodes.size(), -1);
    // A single room is a place without ways: its middle stays.
    const bool room = std::none_of(alive_.begin(), alive_.end(), [](char alive) { return alive != 0; });
    const auto middle = std::max_element(s_.nodes.begin(), s_.nodes.end(), [](const auto& a, const auto& b) {
      return a.clearance < b.clearance;
    });
    for (std::size_t n = 0; n < s_.nodes.size(); ++n) {
      const bool stays = room ? static_cast<std::ptrdiff_t>(n) == middle - s_.nodes.begin() : !s_.nodes[n].edges.empty();
      if (!stays) continue;
      number[n] = static_cast<int>(nodes.size());
      nodes.push_back(s_.nodes[n]);
    }
    for (std::size_t e = 0; e < s_.edges.size(); ++e)
      if (alive_[e]) {
        edges.push_back(std::move(s_.edges[e]));
        edges.back().a = number[static_cast<std::size_t>(edges.back().a)];
        edges.back().b = number[static_cast<std::size_t>(edges.back().b)];
      }
    s_.nodes = std::move(nodes);
    s_.edges = std::move(edges);
    alive_.assign(s_.edges.size(), 1);
    link();
  }

  Skeleton& s_;
  std::vector<char> alive_;
};

}  // namespace

Grid<float> clearances(const OccupancyGrid& map) {
  cv::Mat free(map.height() + 2, map.width() + 2, CV_8U, cv::Scalar(0)), d;
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) free.at<std::uint8_t>(y + 1, x + 1) = map[Cell{x, y}] == CellState::kFree ? 1 : 0;
  cv::distanceTransform(free, d, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  Grid<float> result(map.geometry());
  const auto r = static_cast<float>(map.geometry().resolution);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x) result[Cell{x, y}] = std::max(0.0F, d.at<float>(y + 1, x + 1) - 0.5F) * r;
  return result;
}

Grid<std::uint8_t> thinned(const Grid<std::uint8_t>& mask, const Grid<float>& clearance) {
  Grid<std::uint8_t> lines = mask;
  // Cells of equal clearance in the order in which they come up, so that wide ridges shrink from all sides alike.
  using Entry = std::tuple<float, std::size_t, std::size_t>;  // clearance, turn, cell
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  std::size_t turn = 0;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (lines[i]) queue.emplace(clearance[i], turn++, i);
  while (!queue.empty()) {
    const std::size_t i = std::get<2>(queue.top());
    queue.pop();
    const Cell c = lines.geometry().cell_at(i);
    if (!lines[i]) continue;
    const auto n = around(lines, c);
    if (!simple(n) || ends(n)) continue;
    lines[i] = 0;
    for (std::size_t k = 0; k < 8; ++k)
      if (n[k]) queue.emplace(clearance[step(c, k)], turn++, lines.geometry().index(step(c, k)));
  }
  return lines;
}

Skeleton skeleton_of(const OccupancyGrid& map, const Grid<std::uint8_t>& mask) {
  Skeleton s{{}, {}, clearances(map)};
  Tracer(thinned(largest_part(mask), s.clearance), s).run();
  Cleaner(s).run();
  return s;
}

}  // namespace outrider::decision
