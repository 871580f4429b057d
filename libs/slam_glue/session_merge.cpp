#include "slam_glue/session_merge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "slam_glue/common_ground.hpp"
#include "slam_glue/place_search.hpp"

namespace outrider::slam_glue {
namespace {

constexpr double kNearWay = 50.0;                  // metres of driving whose drift is the window of a closer look
constexpr double kStartM = 0.3, kStartRad = 0.05;  // how well a given start is known

/// The merge under way: the joint graph, and which sessions already lie in the map.
class Merger {
 public:
  Merger(JointGraph& joint, bool starts_known, const MergeSettings& settings)
      : joint_(joint),
        starts_known_(starts_known),
        settings_(settings),
        closer_(settings.loops),
        placed_(joint.sessions(), false) {
    placed_[0] = true;
    closer_.adopt(joint.closures);
  }

  /// False when the session is refused; the joint graph is then as it was.
  bool try_session(std::size_t s, MergeRecord& record);
  bool placed(std::size_t s) const { return placed_[s]; }
  void finish() { joint_.closures = closer_.closures(joint_.graph); }

 private:
  std::vector<LoopClosure> closer_look(const Placement& placement);
  void connect(std::size_t s, const std::vector<LoopClosure>& closures);
  std::size_t verify(std::size_t s, MergeRecord& record) const;  // points that were judged
  void optimise();
  bool place_by_start(std::size_t s, MergeRecord& record);

  JointGraph& joint_;
  bool starts_known_;
  MergeSettings settings_;
  LoopCloser closer_;
  std::vector<bool> placed_;
};

/// Matches every supporting place with the scans around it; keeps those that agree with each other in detail.
std::vector<LoopClosure> Merger::closer_look(const Placement& placement) {
  KeyframeGraph& g = joint_.graph;
  std::vector<LoopClosure> found;
  std::vector<PlaceHit> hits;
  for (const PlaceHit& hit : placement.support) {
    joint_.move(g.frames[hit.frame].session, hit.T_map_robot * inverse(g.poses[hit.frame]));
    const auto near = frames_around(g, hit.frame, placed_);
    if (near.empty()) continue;
    auto closure = closer_.check(g, near.front(), hit.frame, {kNearWay});
    if (!closure || closure->agreement < settings_.least_place_agreement) continue;
    hits.push_back({hit.place, hit.frame, g.poses[near.front()] * closure->T_from_to, closure->share});
    found.push_back(std::move(*closure));
  }
  PlaceSearch strict;
  strict.agree_m = 0.2, strict.agree_rad = 0.04;
  const Placement best = best_placement(joint_, hits, strict);
  std::erase_if(found, [&](const LoopClosure& c) {
    return std::none_of(best.support.begin(), best.support.end(), [&](const PlaceHit& h) { return h.frame == c.to; });
  });
  return found;
}

void Merger::optimise() {
  std::vector<std::size_t> fixed{0};
  for (std::size_t s = 1; s < joint_.sessions(); ++s)
    if (!placed_[s]) fixed.push_back(joint_.begin[s]);
  closer_.optimise(joint_.graph, fixed);
}

/// Ties the session to the map by `closures`, then looks for more of them everywhere.
void Merger::connect(std::size_t s, const std::vector<LoopClosure>& closures) {
  KeyframeGraph& g = joint_.graph;
  const LoopClosure& first = closures.front();
  joint_.move(s, g.poses[first.from] * first.T_from_to * inverse(g.poses[first.to]));
  for (const LoopClosure& c : closures) closer_.accept(g, c);
  placed_[s] = true;
  optimise();
  bool news = false;
  for (std::size_t k = joint_.begin[s]; k < joint_.begin[s + 1]; ++k) news = closer_.look(g, k, true) || news;
  if (news) optimise();
}

std::size_t Merger::verify(std::size_t s, MergeRecord& record) const {
  std::vector<bool> this_one(joint_.sessions(), false), others = placed_;
  this_one[s] = true;
  others[s] = false;
  const CommonGround there = common_ground(joint_.graph, this_one, others);
  const CommonGround back = common_ground(joint_.graph, others, this_one);
  record.agreement = std::min(there.seen.agreement(), back.seen.agreement());
  const std::size_t common = there.common + back.common;
  record.hit_ratio =
      common == 0 ? 0.0 : static_cast<double>(there.common_hits + back.common_hits) / static_cast<double>(common);
  record.overlap_m2 = there.walls_m2;
  record.landmarks_m2 = std::min(there.landmarks_m2, back.landmarks_m2);
  record.missing = std::max(there.missing(), back.missing());
  record.closures = 0;
  for (const PoseEdge& e : joint_.graph.edges) {
    const std::size_t a = joint_.graph.frames[e.from].session, b = joint_.graph.frames[e.to].session;
    record.closures += (a == s && others[b]) || (b == s && others[a]);
  }
  return there.seen.agree + there.seen.conflict + back.seen.agree + back.seen.conflict;
}

/// A given start is believed unless the scans contradict it.
bool Merger::place_by_start(std::size_t s, MergeRecord& record) {
  constexpr std::size_t kEnough = 200;  // points; fewer say nothing
  const bool judged = verify(s, record) > kEnough;
  if (judged && record.agreement < settings_.least_agreement) {
    record.why =
        fmt::format("the scans contradict the given start: {:.0f} % of what both saw agrees", 100.0 * record.agreement);
    return false;
  }
  KeyframeGraph& g = joint_.graph;
  const std::size_t first = joint_.begin[s];
  const Eigen::Vector3d information{1.0 / (kStartM * kStartM), 1.0 / (kStartM * kStartM),
                                    1.0 / (kStartRad * kStartRad)};
  g.edges.push_back({0, first, inverse(g.poses[0]) * g.poses[first], information.asDiagonal().toDenseMatrix(), false});
  record.why = "no place in common was found; it lies where its start was given";
  return placed_[s] = true;
}

bool Merger::try_session(std::size_t s, MergeRecord& record) {
  record.why.clear();
  const auto placements = find_placements(joint_, placed_, s, starts_known_);
  record.places = placements.empty() ? 0 : placements[0].support.size();
  record.rival = placements.size() < 2 ? 0.0 : placements[1].weight / placements[0].weight;
  const KeyframeGraph& g = joint_.graph;
  const std::vector<Pose2> poses = g.poses;
  const std::vector<PoseEdge> edges = g.edges;
  const LoopCloser closer = closer_;
  std::vector<LoopClosure> closures;
  if (record.places < settings_.least_supports)
    record.why = fmt::format("{} of its places fit into the map; expected {} that agree", record.places,
                             settings_.least_supports);
  else if (!starts_known_ && record.rival > settings_.rival)
    record.why = "another placement fits about as well";
  if (record.why.empty()) {
    closures = closer_look(placements[0]);
    if (closures.size() < settings_.least_supports)
      record.why = fmt::format("on a closer look {} of {} places agree", closures.size(), record.places);
  }
  if (record.why.empty()) {
    connect(s, closures);
    verify(s, record);
    if (record.agreement < settings_.least_agreement)
      record.why = fmt::format("one looked through what the other saw: {:.0f} % of the common space agrees",
                               100.0 * record.agreement);
    else if (record.hit_ratio < settings_.least_hit_ratio)
      record.why = fmt::format("{:.0f} % of the walls in common space fall on walls", 100.0 * record.hit_ratio);
    else if (record.overlap_m2 < settings_.least_overlap_m2)
      record.why = fmt::format("the common walls are too few ({:.1f} m²)", record.overlap_m2);
    else if (!starts_known_ && record.landmarks_m2 < settings_.least_landmarks_m2)
      record.why =
          fmt::format("too little pins the place down ({:.1f} m² of walls that end or turn)", record.landmarks_m2);
    else if (!starts_known_ && record.missing > settings_.most_missing)
      record.why = fmt::format(
          "{:.0f} % of what would pin the place down stands on one side only: it may be another "
          "place that looks alike",
          100.0 * record.missing);
    else if (record.closures < settings_.least_supports)
      record.why = "too few places still agree after optimisation";
    else
      return true;
  }
  joint_.graph.poses = poses;
  joint_.graph.edges = edges;
  closer_ = closer;
  placed_[s] = false;
  return starts_known_ && place_by_start(s, record);
}

}  // namespace

std::vector<MergeRecord> merge_sessions(JointGraph& joint, bool starts_known, const MergeSettings& settings) {
  std::vector<MergeRecord> records(joint.sessions() > 0 ? joint.sessions() - 1 : 0);
  Merger merger(joint, starts_known, settings);
  // What fits nowhere yet may fit once another log has made the map larger.
  for (bool news = true; news;) {
    news = false;
    for (std::size_t s = 1; s < joint.sessions(); ++s) {
      if (merger.placed(s)) continue;
      records[s - 1].log = s;
      records[s - 1].accepted = merger.try_session(s, records[s - 1]);
      news = news || records[s - 1].accepted;
    }
  }
  merger.finish();
  return records;
}

}  // namespace outrider::slam_glue
