#include "report/trajectory_crossings.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

namespace outrider::report {
namespace {

constexpr double kLattice = 1e-4;                       // [m]; integer coordinates make orientation tests exact
constexpr double kStraightness = 1e-3;                  // [m]
constexpr std::int64_t kMaxCoordinate = 1'000'000'000;  // 100 km; products stay far from overflow

struct Vertex {
  std::int64_t x = 0, y = 0;
  friend auto operator<=>(const Vertex&, const Vertex&) = default;
};
using Polyline = std::vector<Vertex>;

double distance_to_segment(Point p, Point a, Point b) {
  const double dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
  const double u = length2 > 0.0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / length2, 0.0, 1.0) : 0.0;
  return std::hypot(p.x - a.x - u * dx, p.y - a.y - u * dy);
}

/// Douglas and Peucker 1973, with a stack of its own; which points stay.
std::vector<bool> corners(const std::vector<TimedPose>& path) {
  std::vector<bool> keep(path.size(), false);
  if (path.empty()) return keep;
  keep.front() = keep.back() = true;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, path.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double worst = kStraightness;
    std::size_t at = first;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double d =
          distance_to_segment(path[i].pose.position(), path[first].pose.position(), path[last].pose.position());
      if (d > worst) worst = d, at = i;
    }
    if (at == first) continue;
    keep[at] = true;
    open.emplace_back(first, at);
    open.emplace_back(at, last);
  }
  return keep;
}

Polyline to_lattice(const std::vector<TimedPose>& path) {
  const auto snap = [](double v) {
    const double cells = std::round(v / kLattice);
    assert(std::abs(cells) <= static_cast<double>(kMaxCoordinate));
    return static_cast<std::int64_t>(
        std::clamp(cells, -static_cast<double>(kMaxCoordinate), static_cast<double>(kMaxCoordinate)));
  };
  const std::vector<bool> keep = corners(path);
  Polyline line;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (!keep[i]) continue;
    const Vertex v{snap(path[i].pose.x), snap(path[i].pose.y)};
    if (line.empty() || line.back() != v) line.push_back(v);
  }
  return line;
}

/// Twice the signed area of the triangle (o, a, b): positive when b lies left of the ray from o through a.
std::int64_t cross(Vertex o, Vertex a, Vertex b) { return (a.x - o.x) * (b.y - o.y) - (a.y - o.y) * (b.x - o.x); }

int side(Vertex o, Vertex a, Vertex b) {
  const std::int64_t c = cross(o, a, b);
  return (c > 0) - (c < 0);
}

/// p strictly inside the segment ab.
bool inside_segment(Vertex p, Vertex a, Vertex b) {
  return cross(a, b, p) == 0 && p != a && p != b && std::min(a.x, b.x) <= p.x && p.x <= std::max(a.x, b.x) &&
         std::min(a.y, b.y) <= p.y && p.y <= std::max(a.y, b.y);
}

bool cross_properly(Vertex a, Vertex b, Vertex p, Vertex q) {
  return side(a, b, p) * side(a, b, q) < 0 && side(p, q, a) * side(p, q, b) < 0;
}

struct Segment {
  std::size_t robot = 0;
  std::size_t index = 0;  // of its first vertex
};

struct Box {
  Vertex low, high;
};

Box box_of(Vertex a, Vertex b) {
  return {{std::min(a.x, b.x), std::min(a.y, b.y)}, {std::max(a.x, b.x), std::max(a.y, b.y)}};
}

/// The pairs of segments of two robots whose boxes meet, grouped by robots (first < second).
using MeetingList = std::vector<std::pair<std::size_t, std::size_t>>;
using Meetings = std::map<std::pair<std::size_t, std::size_t>, MeetingList>;

/// A uniform grid with about as many buckets as there are segments.
class Buckets {
 public:
  explicit Buckets(const std::vector<Polyline>& lines) : lines_(lines) {
    Box all{{kMaxCoordinate, kMaxCoordinate}, {-kMaxCoordinate, -kMaxCoordinate}};
    std::size_t segments = 0;
    for (const Polyline& line : lines) {
      segments += line.empty() ? 0 : line.size() - 1;
      for (const Vertex v : line) {
        all.low = {std::min(all.low.x, v.x), std::min(all.low.y, v.y)};
        all.high = {std::max(all.high.x, v.x), std::max(all.high.y, v.y)};
      }
    }
    low_ = all.low;
    side_ = std::clamp<std::int64_t>(std::llround(std::sqrt(static_cast<double>(segments))), 1, 1024);
    edge_ = std::max({all.high.x - all.low.x, all.high.y - all.low.y, std::int64_t{1}}) / side_ + 1;
    buckets_.resize(static_cast<std::size_t>(side_ * side_));
    for (std::size_t robot = 0; robot < lines.size(); ++robot)
      for (std::size_t i = 0; i + 1 < lines[robot].size(); ++i) add({robot, i});
  }

  Meetings meetings() const {
    Meetings result;
    for (std::size_t bucket = 0; bucket < buckets_.size(); ++bucket)
      for (std::size_t i = 0; i < buckets_[bucket].size(); ++i)
        for (std::size_t j = i + 1; j < buckets_[bucket].size(); ++j)
          meet(bucket, buckets_[bucket][i], buckets_[bucket][j], result);
    return result;
  }

 private:
  Box box(Segment s) const { return box_of(lines_[s.robot][s.index], lines_[s.robot][s.index + 1]); }
  std::size_t bucket_of(Vertex v) const {
    return static_cast<std::size_t>((v.y - low_.y) / edge_ * side_ + (v.x - low_.x) / edge_);
  }

  void add(Segment s) {
    const Box b = box(s);
    for (std::int64_t y = (b.low.y - low_.y) / edge_; y <= (b.high.y - low_.y) / edge_; ++y)
      for (std::int64_t x = (b.low.x - low_.x) / edge_; x <= (b.high.x - low_.x) / edge_; ++x)
        buckets_[static_cast<std::size_t>(y * side_ + x)].push_back(s);
  }

  void meet(std::size_t bucket, Segment s, Segment t, Meetings& result) const {
    if (s.robot == t.robot) return;
    const Box a = box(s), b = box(t);
    const Vertex low{std::max(a.low.x, b.low.x), std::max(a.low.y, b.low.y)};
    const Vertex high{std::min(a.high.x, b.high.x), std::min(a.high.y, b.high.y)};
    if (low.x > high.x || low.y > high.y) return;
    // Both may share several buckets; the one that holds the common lower-left corner speaks.
    if (bucket_of(low) == bucket) result[{s.robot, t.robot}].emplace_back(s.index, t.index);
  }

  const std::vector<Polyline>& lines_;
  Vertex low_;
  std::int64_t side_ = 1, edge_ = 1;
  std::vector<std::vector<Segment>> buckets_;  // segments in the order of their robots, so s.robot <= t.robot
};

/// The vertices that lie on each segment of a line.
using PointsOnSegments = std::vector<std::vector<Vertex>>;

/// The line with all of these points as vertices; equal neighbours once.
Polyline with_points(const Polyline& line, PointsOnSegments points) {
  Polyline result{line.front()};
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto along = [&](Vertex v) { return std::abs(v.x - line[i].x) + std::abs(v.y - line[i].y); };
    std::sort(points[i].begin(), points[i].end(), [&](Vertex a, Vertex b) { return along(a) < along(b); });
    for (const Vertex v : points[i])
      if (v != result.back()) result.push_back(v);
    if (line[i + 1] != result.back()) result.push_back(line[i + 1]);
  }
  return result;
}

/// Splits both lines so that they touch each other at common vertices only, apart from proper crossings. The second
/// pass brings a vertex of one line, which the first put on the other, to every segment of the line it came from.
std::pair<Polyline, Polyline> split_at_contacts(const Polyline& a, const Polyline& b, const MeetingList& meetings) {
  PointsOnSegments on_a(a.size() - 1), on_b(b.size() - 1);
  for (const auto& [i, j] : meetings) {
    for (const Vertex v : {b[j], b[j + 1]})
      if (inside_segment(v, a[i], a[i + 1])) on_a[i].push_back(v);
    for (const Vertex v : {a[i], a[i + 1]})
      if (inside_segment(v, b[j], b[j + 1])) on_b[j].push_back(v);
  }
  const PointsOnSegments first_a = on_a, first_b = on_b;
  for (const auto& [i, j] : meetings) {
    for (const Vertex v : first_b[j])
      if (inside_segment(v, a[i], a[i + 1])) on_a[i].push_back(v);
    for (const Vertex v : first_a[i])
      if (inside_segment(v, b[j], b[j + 1])) on_b[j].push_back(v);
  }
  return {with_points(a, std::move(on_a)), with_points(b, std::move(on_b))};
}

/// x lies left of the path from -> at -> to. x is in the direction of neither; a path that turns on the spot has no
/// left.
bool left_of_corner(Vertex from, Vertex at, Vertex to, Vertex x) {
  const int turn = side(at, to, from);
  const bool behind_to = side(at, to, x) > 0, before_from = side(at, x, from) > 0;
  if (turn > 0) return behind_to && before_from;
  if (turn < 0) return behind_to || before_from;
  const bool opposite = (to.x - at.x) * (from.x - at.x) + (to.y - at.y) * (from.y - at.y) < 0;
  return opposite && behind_to;
}

/// Does `a` change sides of `b` along the shared stretch that begins at the common vertex a[i] == b[j]? False when the
/// stretch began earlier.
bool changes_side(const Polyline& a, std::size_t i, const Polyline& b, std::size_t j) {
  if (i == 0 || j == 0 || j + 1 == b.size()) return false;
  if (a[i - 1] == b[j - 1] || a[i - 1] == b[j + 1]) return false;
  std::size_t i_end = i, j_end = j;
  const bool along = i + 1 < a.size() && a[i + 1] == b[j + 1];
  while (i_end + 1 < a.size() && (along ? j_end + 1 < b.size() : j_end > 0) &&
         a[i_end + 1] == (along ? b[j_end + 1] : b[j_end - 1])) {
    ++i_end;
    along ? ++j_end : --j_end;
  }
  if (i_end + 1 == a.size() || j_end == 0 || j_end + 1 == b.size()) return false;
  return left_of_corner(b[j - 1], b[j], b[j + 1], a[i - 1]) !=
         left_of_corner(b[j_end - 1], b[j_end], b[j_end + 1], a[i_end + 1]);
}

/// Crossings at common vertices, after every contact has been made one.
std::size_t crossings_at_vertices(const Polyline& a, const Polyline& b) {
  std::vector<std::pair<Vertex, std::size_t>> sorted;
  for (std::size_t j = 0; j < b.size(); ++j) sorted.emplace_back(b[j], j);
  std::sort(sorted.begin(), sorted.end());
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (auto it = std::lower_bound(sorted.begin(), sorted.end(), std::pair(a[i], std::size_t{0}));
         it != sorted.end() && it->first == a[i]; ++it)
      count += changes_side(a, i, b, it->second);
  return count;
}

bool in_contact(Vertex a0, Vertex a1, Vertex b0, Vertex b1) {
  const auto on = [](Vertex v, Vertex p, Vertex q) { return v == p || v == q || inside_segment(v, p, q); };
  return on(b0, a0, a1) || on(b1, a0, a1) || on(a0, b0, b1) || on(a1, b0, b1);
}

std::size_t crossings_of(const Polyline& a, const Polyline& b, const MeetingList& meetings) {
  std::size_t count = 0;
  bool contact = false;
  for (const auto& [i, j] : meetings) {
    if (cross_properly(a[i], a[i + 1], b[j], b[j + 1]))
      ++count;
    else
      contact = contact || in_contact(a[i], a[i + 1], b[j], b[j + 1]);
  }
  if (!contact) return count;
  const auto [split_a, split_b] = split_at_contacts(a, b, meetings);
  return count + crossings_at_vertices(split_a, split_b);
}

}  // namespace

Crossings trajectory_crossings(std::span<const std::vector<TimedPose>> trajectories) {
  std::vector<Polyline> lines;
  for (const auto& trajectory : trajectories) lines.push_back(to_lattice(trajectory));
  Crossings result;
  result.per_robot.resize(lines.size());
  for (const auto& [robots, meetings] : Buckets(lines).meetings()) {
    const std::size_t n = crossings_of(lines[robots.first], lines[robots.second], meetings);
    result.count += n;
    result.per_robot[robots.first] += n;
    result.per_robot[robots.second] += n;
  }
  return result;
}

}  // namespace outrider::report
