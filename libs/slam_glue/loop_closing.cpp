#include "slam_glue/loop_closing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <queue>

#include "slam_glue/correlative.hpp"
#include "slam_glue/point_matcher.hpp"

namespace outrider::slam_glue {
namespace {

constexpr std::size_t kVisit = 4;      // keyframes on either side that make up the earlier visit
constexpr std::size_t kLooking = 3;    // keyframes before k that look with it
constexpr double kSearchCell = 0.15, kMatchCell = 0.05;  // spacing of the points that search and match [m]
constexpr double kSearchReach = 12.0;  // farther points are too sparse to search with [m]
constexpr double kResolution = 0.1;    // of the search [m]
constexpr int kLevels = 5;
constexpr double kNoise = 0.03;        // of a point's distance to its surface [m]
constexpr double kLeastScore = 0.4;    // of the search
constexpr double kLoopCost = 0.3;      // a closure's own error, in metres of driving
constexpr std::size_t kMostCandidates = 2, kApartFrames = 8;

double magnitude(const Pose2& T) { return std::hypot(T.x, T.y); }

std::vector<std::size_t> range(std::size_t begin, std::size_t end) {
  std::vector<std::size_t> all(end - begin);
  std::iota(all.begin(), all.end(), begin);
  return all;
}

}  // namespace

/// Metres of driving whose drift lies between `k` and every other keyframe, along the best way through the graph.
std::vector<double> LoopCloser::drift_from(const KeyframeGraph& graph, std::size_t k) const {
  std::vector<std::vector<std::pair<std::size_t, double>>> links(graph.size());
  for (const PoseEdge& e : graph.edges) {
    const double cost = e.robust ? kLoopCost : magnitude(e.T_from_to) + 0.5 * std::abs(e.T_from_to.theta);
    links[e.from].emplace_back(e.to, cost);
    links[e.to].emplace_back(e.from, cost);
  }
  std::vector<double> way(graph.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  way[k] = 0.0;
  open.emplace(0.0, k);
  while (!open.empty()) {
    const auto [d, i] = open.top();
    open.pop();
    if (d > way[i]) continue;
    for (const auto& [j, cost] : links[i])
      if (d + cost < way[j]) open.emplace(way[j] = d + cost, j);
  }
  return way;
}

std::vector<std::size_t> LoopCloser::candidates(const KeyframeGraph& graph, std::size_t k,
                                                const std::vector<double>& way, bool other_sessions) const {
  const Keyframe& frame = graph.frames[k];
  const Point view = graph.poses[k] * frame.view;
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t j = 0; j < graph.size(); ++j) {
    const Keyframe& other = graph.frames[j];
    if (other_sessions && other.session == frame.session) continue;
    if (other.session == frame.session && std::abs(frame.path_m - other.path_m) < settings_.recent_m) continue;
    if (!std::isfinite(way[j])) continue;
    const double radius = std::min(settings_.most_radius_m, settings_.drift_m * way[j]);
    const double apart = distance(view, graph.poses[j] * other.view) - radius;
    if (apart < settings_.view_m) near.emplace_back(std::max(0.0, apart) + 0.1 * radius, j);
  }
  std::sort(near.begin(), near.end());
  std::vector<std::size_t> chosen;
  for (const auto& [apart, j] : near) {
    const bool fresh = std::all_of(chosen.begin(), chosen.end(), [j = j](std::size_t c) {
      return (c > j ? c - j : j - c) >= kApartFrames;
    });
    if (fresh) chosen.push_back(j);
    if (chosen.size() == kMostCandidates) break;
  }
  return chosen;
}

std::optional<LoopClosure> LoopCloser::check(KeyframeGraph& graph, std::size_t j, std::size_t k, double way) {
  const auto [begin, end] = graph.neighbours(j, kVisit, kVisit);
  const auto [first, last] = graph.neighbours(k, kLooking, 0);
  const auto target = graph.gather(begin, end, j);
  const auto source = thinned(graph.gather(first, last, k), kMatchCell);
  const Pose2 expected = inverse(graph.poses[j]) * graph.poses[k];
  LoopClosure closure{j, k};
  Pose2 start = expected;
  const double radius = std::min(settings_.most_radius_m, settings_.drift_m * way);
  if (radius > settings_.least_radius_m) {
    const auto sparse = thinned(within(source, {}, kSearchReach), kSearchCell);
    const auto there = within(target, expected.position(), kSearchReach + 1.5 * radius + 1.0);
    const CorrelativeMatcher matcher(thinned(there, 0.5 * kResolution), kResolution, kLevels);
    const SearchWindow window{expected, radius, std::min(kPi, 0.06 + settings_.drift_rad * way)};
    const auto hit = matcher.best(sparse, window, kLeastScore);
    if (!hit) return std::nullopt;
    start = hit->T_map_robot;
    if (matcher.best(sparse, window, settings_.rival * hit->score, start)) closure.why = "another place fits as well";
  }
  const PointMatch match = match_points(PointMap(target), source, start, kNoise);
  closure.T_from_to = match.T_map_robot;
  closure.information = match.information;
  closure.share = match.share;
  closure.correction_m = magnitude(inverse(expected) * match.T_map_robot);
  const double turned = std::abs(wrap_angle(match.T_map_robot.theta - expected.theta));
  // What the later visit saw must fit what the earlier one could see, and the other way round.
  const Pose2 kept = graph.poses[k];
  std::vector<Pose2> moved(graph.poses.begin() + static_cast<std::ptrdiff_t>(first),
                           graph.poses.begin() + static_cast<std::ptrdiff_t>(last));
  for (std::size_t i = first; i < last; ++i)
    graph.poses[i] = graph.poses[j] * match.T_map_robot * (inverse(kept) * moved[i - first]);
  const Visibility there = judge(graph, range(begin, end), k, source);
  const Visibility back = judge(graph, range(first, last), j, thinned(target, kSearchCell));
  std::copy(moved.begin(), moved.end(), graph.poses.begin() + static_cast<std::ptrdiff_t>(first));
  closure.agreement = std::min(there.agreement(), back.agreement());
  if (closure.share < settings_.least_share) return std::nullopt;
  if (closure.agreement < settings_.least_agreement)
    closure.why = "one visit looked through what the other saw";
  else if (closure.why.empty() && (closure.agreement < settings_.sure_agreement ||
                                   closure.correction_m > settings_.small_m || turned > settings_.small_rad))
    closure.why = "no second witness";
  return closure;
}

/// Whether two closures, taken some way apart, lead to the same correction.
bool LoopCloser::witness(const KeyframeGraph& graph, const LoopClosure& a, const LoopClosure& b) const {
  const double way = std::abs(graph.frames[a.to].path_m - graph.frames[b.to].path_m);
  if (way < settings_.witness_m || way > 20.0 * settings_.witness_m) return false;
  if (graph.frames[a.from].session != graph.frames[b.from].session) return false;
  const Pose2 earlier = inverse(graph.poses[b.from]) * graph.poses[a.from];
  const Pose2 later = inverse(graph.poses[a.to]) * graph.poses[b.to];
  const Pose2 round = earlier * a.T_from_to * later * inverse(b.T_from_to);
  const double driven = way + std::abs(graph.frames[a.from].path_m - graph.frames[b.from].path_m);
  return magnitude(round) < 0.15 + settings_.drift_m * driven &&
         std::abs(round.theta) < 0.03 + settings_.drift_rad * driven;
}

void LoopCloser::accept(KeyframeGraph& graph, const LoopClosure& closure) {
  graph.edges.push_back({closure.from, closure.to, closure.T_from_to, closure.information, true});
  accepted_.push_back(closure);
  accepted_.back().why.clear();
}

void LoopCloser::adopt(const std::vector<LoopClosure>& closures) {
  for (const LoopClosure& c : closures) (c.accepted() ? accepted_ : refused_).push_back(c);
}

bool LoopCloser::look(KeyframeGraph& graph, std::size_t k, bool other_sessions) {
  const std::vector<double> way = drift_from(graph, k);
  bool news = false;
  for (const std::size_t j : candidates(graph, k, way, other_sessions)) {
    const auto closure = check(graph, j, k, way[j]);
    if (!closure) continue;
    if (closure->accepted()) {
      accept(graph, *closure);
      news = news || closure->correction_m > 0.05;
    } else if (closure->why == "no second witness") {
      bool seen = false;
      for (auto& other : pending_)
        if (witness(graph, other, *closure)) {
          accept(graph, other);
          other.share = -1.0;
          seen = true;
        }
      std::erase_if(pending_, [](const LoopClosure& c) { return c.share < 0.0; });
      if (seen) accept(graph, *closure);
      else pending_.push_back(*closure);
      news = news || seen;
    } else {
      refused_.push_back(*closure);
    }
  }
  return news;
}

void LoopCloser::optimise(KeyframeGraph& graph, const std::vector<std::size_t>& fixed) {
  constexpr double kWrongM = 0.3, kWrongRad = 0.06;
  for (int round = 0; round < 4; ++round) {
    slam_glue::optimise(graph.poses, graph.edges, fixed);
    bool dropped = false;
    std::erase_if(graph.edges, [&](const PoseEdge& e) {
      if (!e.robust) return false;
      const Pose2 r = residual(e, graph.poses);
      if (magnitude(r) < kWrongM && std::abs(r.theta) < kWrongRad) return false;
      for (auto& c : accepted_)
        if (c.from == e.from && c.to == e.to) c.why = "disagrees with the other closures";
      dropped = true;
      return true;
    });
    for (const auto& c : accepted_)
      if (!c.accepted()) refused_.push_back(c);
    std::erase_if(accepted_, [](const LoopClosure& c) { return !c.accepted(); });
    if (!dropped) return;
  }
}

std::vector<LoopClosure> LoopCloser::closures(const KeyframeGraph&) const {
  std::vector<LoopClosure> all = accepted_;
  all.insert(all.end(), pending_.begin(), pending_.end());
  all.insert(all.end(), refused_.begin(), refused_.end());
  std::stable_sort(all.begin(), all.end(), [](const LoopClosure& a, const LoopClosure& b) { return a.to < b.to; });
  return all;
}

}  // namespace outrider::slam_glue
