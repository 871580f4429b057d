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

constexpr std::size_t kVisit = 4;                        // keyframes on either side that make up the earlier visit
constexpr std::size_t kLooking = 3;                      // keyframes before k that look with it
constexpr double kSearchCell = 0.15, kMatchCell = 0.05;  // spacing of the points that search and match [m]
constexpr double kSearchReach = 12.0;                    // farther points are too sparse to search with [m]
constexpr double kResolution = 0.1;                      // of the search [m]
constexpr int kLevels = 5;
constexpr double kNoise = 0.03;         // of a point's distance to its surface [m]
constexpr double kLeastScore = 0.4;     // of the search
constexpr double kLoopCost = 0.3;       // a closure's own error, in metres of driving
constexpr double kVagueM = 3.0;         // where it may lie farther off, a search is dear:
constexpr std::size_t kVagueEvery = 2;  // only so many keyframes look
constexpr std::size_t kMostCandidates = 2, kApartFrames = 8;

double magnitude(const Pose2& T) { return std::hypot(T.x, T.y); }

std::vector<std::size_t> range(std::size_t begin, std::size_t end) {
  std::vector<std::size_t> all(end - begin);
  std::iota(all.begin(), all.end(), begin);
  return all;
}

}  // namespace

/// What lies between `k` and every other keyframe, along the best way through the graph.
std::vector<Drift> LoopCloser::drift_from(const KeyframeGraph& graph, std::size_t k) const {
  struct Link {
    std::size_t to;
    double cost;
    const PoseEdge* edge;
  };
  std::vector<std::vector<Link>> links(graph.size());
  for (const PoseEdge& e : graph.edges) {
    const double cost = e.robust ? kLoopCost : magnitude(e.T_from_to) + 0.5 * std::abs(e.T_from_to.theta);
    links[e.from].push_back({e.to, cost, &e});
    links[e.to].push_back({e.from, cost, &e});
  }
  std::vector<Drift> drift(graph.size(), {std::numeric_limits<double>::infinity(), Eigen::Matrix3d::Zero()});
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  drift[k].way_m = 0.0;
  open.emplace(0.0, k);
  while (!open.empty()) {
    const auto [d, i] = open.top();
    open.pop();
    if (d > drift[i].way_m) continue;
    for (const Link& link : links[i]) {
      if (d + link.cost >= drift[link.to].way_m) continue;
      drift[link.to] = {d + link.cost, drift[i].blind};
      Eigen::Matrix3d& P = drift[link.to].blind;
      if (!P.isZero(0.0)) {  // a turn moves what lies farther on
        Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
        J(0, 2) = graph.poses[i].y - graph.poses[link.to].y;
        J(1, 2) = graph.poses[link.to].x - graph.poses[i].x;
        P = J * P * J.transpose();
      }
      if (link.edge->blind) P.diagonal() += link.edge->information.diagonal().cwiseInverse();
      open.emplace(d + link.cost, link.to);
    }
  }
  return drift;
}

double LoopCloser::radius(const Drift& drift) const {
  return std::min(settings_.most_radius_m,
                  settings_.drift_m * drift.way_m + 2.5 * std::sqrt(drift.blind(0, 0) + drift.blind(1, 1)));
}

double LoopCloser::turn(const Drift& drift) const {
  return std::min(kPi, 0.06 + settings_.drift_rad * drift.way_m + 2.5 * std::sqrt(drift.blind(2, 2)));
}

bool LoopCloser::looks_widely(std::size_t k, const Drift& drift) const {
  return k % kVagueEvery == 0 || radius(drift) < kVagueM;
}

std::vector<std::size_t> LoopCloser::candidates(const KeyframeGraph& graph, std::size_t k,
                                                const std::vector<Drift>& drift, bool other_sessions) const {
  const Keyframe& frame = graph.frames[k];
  const Point view = graph.poses[k] * frame.view;
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t j = 0; j < graph.size(); ++j) {
    const Keyframe& other = graph.frames[j];
    if (!other.kept() || (other_sessions && other.session == frame.session)) continue;
    if (other.session == frame.session && std::abs(frame.path_m - other.path_m) < settings_.recent_m) continue;
    if (!std::isfinite(drift[j].way_m)) continue;
    const double reach = radius(looks_widely(k, drift[j]) ? drift[j] : Drift{drift[j].way_m});
    const double apart = distance(view, graph.poses[j] * other.view);
    if (apart - reach > settings_.view_m) continue;
    // Where poses are vague all are near; the nearest are still the likeliest.
    near.emplace_back(std::max(0.0, apart - reach) + 0.1 * reach + (drift[j].blind.isZero(0.0) ? 0.0 : 0.01 * apart),
                      j);
  }
  std::sort(near.begin(), near.end());
  std::vector<std::size_t> chosen;
  for (const auto& [apart, j] : near) {
    const bool fresh = std::all_of(chosen.begin(), chosen.end(),
                                   [j = j](std::size_t c) { return (c > j ? c - j : j - c) >= kApartFrames; });
    if (fresh) chosen.push_back(j);
    if (chosen.size() == kMostCandidates) break;
  }
  return chosen;
}

std::optional<LoopClosure> LoopCloser::check(KeyframeGraph& graph, std::size_t j, std::size_t k, const Drift& drift) {
  const auto [begin, end] = graph.neighbours(j, kVisit, kVisit);
  const auto [first, last] = graph.neighbours(k, kLooking, 0);
  const auto target = graph.gather(begin, end, j);
  const auto source = thinned(graph.gather(first, last, k), kMatchCell);
  const Pose2 expected = inverse(graph.poses[j]) * graph.poses[k];
  LoopClosure closure{j, k};
  Pose2 start = expected;
  const double reach = radius(drift);
  if (reach > settings_.least_radius_m) {
    const auto sparse = thinned(within(source, {}, kSearchReach), kSearchCell);
    const auto there = within(target, expected.position(), kSearchReach + 1.5 * reach + 1.0);
    const CorrelativeMatcher matcher(thinned(there, 0.5 * kResolution), kResolution, kLevels);
    const SearchWindow window{expected, reach, turn(drift)};
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

bool LoopCloser::shown_before(const KeyframeGraph& graph, std::size_t k) const {
  constexpr std::size_t kNear = 3;  // keyframes from k to one that is tied to an earlier visit
  constexpr double kSameM = 0.5, kSameRad = 0.35;
  const bool tied = std::any_of(graph.edges.rbegin(), graph.edges.rend(),
                                [&](const PoseEdge& e) { return e.robust && e.to + kNear >= k && e.to <= k + kNear; });
  if (!tied) return false;
  for (std::size_t j = 0; j < k; ++j) {
    const Keyframe& other = graph.frames[j];
    if (!other.kept() || graph.frames[k].path_m - other.path_m < settings_.recent_m) continue;
    if (distance(graph.poses[j].position(), graph.poses[k].position()) < kSameM &&
        std::abs(wrap_angle(graph.poses[j].theta - graph.poses[k].theta)) < kSameRad)
      return true;
  }
  return false;
}

void LoopCloser::adopt(const std::vector<LoopClosure>& closures) {
  for (const LoopClosure& c : closures) (c.accepted() ? accepted_ : refused_).push_back(c);
}

bool LoopCloser::look(KeyframeGraph& graph, std::size_t k, bool other_sessions) {
  const std::vector<Drift> drift = drift_from(graph, k);
  bool news = false;
  for (const std::size_t j : candidates(graph, k, drift, other_sessions)) {
    // Dead reckoning is often better than feared, and a wide search finds more that looks alike: the near one comes
    // first.
    auto closure = check(graph, j, k, {drift[j].way_m});
    const bool widely = !drift[j].blind.isZero(0.0) && looks_widely(k, drift[j]);
    if (widely && (!closure || !closure->accepted()))
      if (auto other = check(graph, j, k, drift[j])) closure = std::move(other);
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
      if (seen)
        accept(graph, *closure);
      else
        pending_.push_back(*closure);
      news = news || seen;
    } else {
      refused_.push_back(*closure);
    }
  }
  return news;
}

void LoopCloser::optimise(KeyframeGraph& graph, const std::vector<std::size_t>& fixed) {
  constexpr double kWrongM = 0.3, kWrongRad = 0.06;
  // Closures that correct a lot would hardly pull under their kernel: first a wide one brings them near.
  constexpr double kFarM = 1.5, kFarRad = 0.2, kWide = 300.0;
  const bool far = std::any_of(graph.edges.begin(), graph.edges.end(), [&](const PoseEdge& e) {
    const Pose2 r = residual(e, graph.poses);
    return e.robust && (magnitude(r) > kFarM || std::abs(r.theta) > kFarRad);
  });
  if (far) slam_glue::optimise(graph.poses, graph.edges, fixed, kWide);
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
