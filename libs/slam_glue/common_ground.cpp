#include "slam_glue/common_ground.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace outrider::slam_glue {
namespace {

constexpr double kReach = 12.0;          // frames farther away do not judge [m]
constexpr std::size_t kMostJudges = 16;  // frames that judge another's points
constexpr double kPointCell = 0.2;       // spacing of the judged points [m]
constexpr double kCell = 0.2;            // of the areas [m]
constexpr double kFacesAlong = 0.5;      // cosine between a landmark's normal and the way the place could slide
constexpr SightLimits kStrict{0.12, 0.02, 0.2, 0.01, true};

using Cells = std::set<std::pair<int, int>>;

std::pair<int, int> cell_of(Point p) {
  return {static_cast<int>(std::floor(p.x / kCell)), static_cast<int>(std::floor(p.y / kCell))};
}

double area(const Cells& cells) { return static_cast<double>(cells.size()) * kCell * kCell; }

/// The surfaces that its own side takes for lasting.
std::vector<bool> lasting(const KeyframeGraph& graph, std::size_t k, const std::vector<SurfacePoint>& points,
                          const std::vector<bool>& side) {
  std::vector<std::size_t> others = frames_around(graph, k, side);
  std::erase(others, k);
  std::vector<bool> lasts;
  for (const Sightings& s : sightings(graph, others, k, points, kStrict))
    lasts.push_back(s.there >= 2 && 4 * s.through <= s.there);
  return lasts;
}

/// Along which the surfaces bind a place least.
Point sliding_direction(const std::vector<SurfacePoint>& points, const std::vector<bool>& counts) {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!counts[i]) continue;
    const Point n = points[i].normal;
    xx += n.x * n.x, xy += n.x * n.y, yy += n.y * n.y;
  }
  const double across = 0.5 * std::atan2(2.0 * xy, xx - yy);
  return {-std::sin(across), std::cos(across)};
}

/// Collects a side's frames into areas.
struct Areas {
  Cells walls, landmarks, missing;
  Cells present;  ///< lasting, and seen by the other side

  void add_lasting(const KeyframeGraph& graph, std::size_t k, const std::vector<SurfacePoint>& points,
                   const std::vector<bool>& side, const std::vector<std::size_t>& judges) {
    const std::vector<bool> lasts = lasting(graph, k, points, side);
    const Point slide = sliding_direction(points, lasts);
    const std::vector<Sightings> there = sightings(graph, judges, k, points, kStrict);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!lasts[i]) continue;
      const auto cell = cell_of(graph.poses[k] * points[i].p);
      const Point n = points[i].normal;
      if (there[i].there == 0 && there[i].through > 0) missing.insert(cell);
      if (there[i].there > 0) present.insert(cell);
      if (there[i].there > 0 && std::abs(n.x * slide.x + n.y * slide.y) > kFacesAlong) landmarks.insert(cell);
    }
  }
  /// What some frame missed another may have seen.
  void finish() {
    std::erase_if(missing, [this](const auto& cell) { return present.contains(cell); });
  }
};

}  // namespace

std::vector<std::size_t> frames_around(const KeyframeGraph& graph, std::size_t k, const std::vector<bool>& wanted) {
  const Point view = graph.poses[k] * graph.frames[k].view;
  std::vector<std::pair<double, std::size_t>> near;
  for (std::size_t j = 0; j < graph.size(); ++j) {
    if (!wanted[graph.frames[j].session] || !graph.frames[j].kept()) continue;
    const double apart = distance(view, graph.poses[j] * graph.frames[j].view);
    if (apart < kReach) near.emplace_back(apart, j);
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), kMostJudges));
  std::vector<std::size_t> frames;
  for (const auto& [apart, j] : near) frames.push_back(j);
  return frames;
}

CommonGround common_ground(const KeyframeGraph& graph, const std::vector<bool>& whose, const std::vector<bool>& by) {
  CommonGround all;
  Areas areas;
  for (std::size_t k = 0; k < graph.size(); k += 2) {
    if (!whose[graph.frames[k].session] || !graph.frames[k].kept()) continue;
    const auto judges = frames_around(graph, k, by);
    if (judges.empty()) continue;
    const auto points = thinned(graph.frames[k].points, kPointCell);
    std::vector<bool> agrees;
    const Visibility v = judge(graph, judges, k, points, &agrees);
    all.seen.agree += v.agree;
    all.seen.conflict += v.conflict;
    all.seen.points += v.points;
    if (2 * (v.agree + v.conflict) >= v.points) all.common += v.points, all.common_hits += v.agree;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (agrees[i]) areas.walls.insert(cell_of(graph.poses[k] * points[i].p));
    areas.add_lasting(graph, k, points, whose, judges);
  }
  areas.finish();
  all.walls_m2 = area(areas.walls);
  all.landmarks_m2 = area(areas.landmarks);
  all.missing_m2 = area(areas.missing);
  return all;
}

}  // namespace outrider::slam_glue
