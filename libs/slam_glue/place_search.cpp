#include "slam_glue/place_search.hpp"

#include <algorithm>
#include <cmath>

namespace outrider::slam_glue {
namespace {

constexpr std::size_t kVisit = 8;      // keyframes on either side that make up a place
constexpr double kReach = 10.0;        // of a place [m]
constexpr double kCell = 0.2;          // of the search [m]
constexpr int kLevels = 7;
constexpr double kPointCell = 0.25, kMapCell = 0.1;  // spacing of the points [m]
constexpr double kNearM = 1.0, kNearRad = 0.2;       // how wrong a given start may be
constexpr double kSecond = 0.9;        // a second place for a hit scores at least so much of the first

struct Box {
  Point centre;
  double half = 0.0;  ///< edge [m]
};

Box box_around(const std::vector<SurfacePoint>& points) {
  Point low = points.front().p, high = low;
  for (const auto& q : points) {
    low = {std::min(low.x, q.p.x), std::min(low.y, q.p.y)};
    high = {std::max(high.x, q.p.x), std::max(high.y, q.p.y)};
  }
  return {{0.5 * (low.x + high.x), 0.5 * (low.y + high.y)}, 0.5 * std::max(high.x - low.x, high.y - low.y)};
}

std::vector<SurfacePoint> map_points(const JointGraph& joint, const std::vector<bool>& placed) {
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < joint.graph.size(); ++i) {
    if (!placed[joint.graph.frames[i].session]) continue;
    for (const auto& q : joint.graph.frames[i].points) points.push_back(joint.graph.poses[i] * q);
  }
  return thinned(points, kMapCell);
}

/// Frames of session `s` to be searched for, evenly along its way.
std::vector<std::size_t> places(const JointGraph& joint, std::size_t s, const PlaceSearch& search) {
  const double length = joint.graph.frames[joint.begin[s + 1] - 1].path_m;
  const double spacing = std::max(search.spacing_m, length / static_cast<double>(search.most_places));
  std::vector<std::size_t> chosen;
  double due = std::min(0.5 * spacing, 0.5 * length);
  for (std::size_t k = joint.begin[s]; k < joint.begin[s + 1]; ++k) {
    if (joint.graph.frames[k].path_m < due || !joint.graph.frames[k].kept()) continue;
    chosen.push_back(k);
    due = joint.graph.frames[k].path_m + spacing;
  }
  return chosen;
}

/// Whether two places say the same of the session's position, as far as its drift allows.
bool agree(const JointGraph& joint, const PlaceHit& a, const PlaceHit& b, const PlaceSearch& search) {
  const Pose2 expected = a.T_map_robot * (inverse(joint.graph.poses[a.frame]) * joint.graph.poses[b.frame]);
  const double way = std::abs(joint.graph.frames[a.frame].path_m - joint.graph.frames[b.frame].path_m);
  return distance(expected.position(), b.T_map_robot.position()) < search.agree_m + search.drift_m * way &&
         std::abs(wrap_angle(expected.theta - b.T_map_robot.theta)) < search.agree_rad + search.drift_rad * way;
}

}  // namespace

Placement best_placement(const JointGraph& joint, const std::vector<PlaceHit>& hits, const PlaceSearch& search) {
  Placement best;
  for (const PlaceHit& seed : hits) {
    Placement p{seed.T_map_robot * inverse(joint.graph.poses[seed.frame]), {}, 0.0};
    for (const PlaceHit& hit : hits) {
      if (!agree(joint, seed, hit, search)) continue;
      if (!p.support.empty() && p.support.back().place == hit.place) continue;  // the better of a place comes first
      p.support.push_back(hit);
      p.weight += hit.score;
    }
    if (p.weight > best.weight) best = std::move(p);
  }
  return best;
}

std::vector<Placement> find_placements(const JointGraph& joint, const std::vector<bool>& placed, std::size_t s,
                                       bool start_known, const PlaceSearch& search) {
  const std::vector<SurfacePoint> map = map_points(joint, placed);
  if (map.empty()) return {};
  const CorrelativeMatcher matcher(map, kCell, kLevels);
  const Box box = box_around(map);
  std::vector<PlaceHit> hits;
  const std::vector<std::size_t> frames = places(joint, s, search);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::size_t k = frames[i];
    const auto [begin, end] = joint.graph.neighbours(k, kVisit, kVisit);
    const auto place = thinned(within(joint.graph.gather(begin, end, k), {}, kReach), kPointCell);
    const double way = joint.graph.frames[k].path_m;
    const SearchWindow window =
        start_known ? SearchWindow{joint.graph.poses[k], kNearM + search.drift_m * way, kNearRad + search.drift_rad * way}
                    : SearchWindow{{box.centre.x, box.centre.y, 0.0}, box.half + 1.0, kPi};
    const auto first = matcher.best(place, window, search.least_score);
    if (!first) continue;
    hits.push_back({i, k, first->T_map_robot, first->score});
    const auto second = matcher.best(place, window, std::max(search.least_score, kSecond * first->score),
                                     first->T_map_robot);
    if (second) hits.push_back({i, k, second->T_map_robot, second->score});
  }
  std::vector<Placement> placements;
  while (placements.size() < 2 && !hits.empty()) {
    placements.push_back(best_placement(joint, hits, search));
    const auto& support = placements.back().support;
    std::erase_if(hits, [&](const PlaceHit& h) {
      return std::any_of(support.begin(), support.end(), [&](const PlaceHit& u) {
        return u.place == h.place && u.T_map_robot == h.T_map_robot;
      });
    });
  }
  return placements;
}

}  // namespace outrider::slam_glue
