#include "slam_glue/map_alignment.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "slam_glue/correlative.hpp"

namespace outrider::slam_glue {
namespace {

constexpr double kSigma = 0.15;         // of the nearness of two walls [m]
constexpr double kGoodEnough = 0.75;    // a nearness at which the frames need no search
constexpr double kSearchCell = 0.25;    // of the exhaustive search [m]
constexpr double kNearM = 1.5, kNearRad = 0.15;  // "as they are", give or take
constexpr std::size_t kMostPoints = 4000;

bool faces_free(const OccupancyGrid& grid, Cell c) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const Cell n{c.x + dx, c.y + dy};
      if (grid.contains(n) && grid[n] == CellState::kFree) return true;
    }
  return false;
}

/// Walls that a sensor can see, as points.
std::vector<SurfacePoint> walls(const OccupancyGrid& grid) {
  std::vector<SurfacePoint> points;
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const Cell c = grid.geometry().cell_at(i);
    if (grid[i] == CellState::kOccupied && faces_free(grid, c)) points.push_back({grid.geometry().center(c), {}});
  }
  return points;
}

Point middle(const std::vector<SurfacePoint>& points) {
  Point low = points.front().p, high = low;
  for (const auto& q : points) {
    low = {std::min(low.x, q.p.x), std::min(low.y, q.p.y)};
    high = {std::max(high.x, q.p.x), std::max(high.y, q.p.y)};
  }
  return {0.5 * (low.x + high.x), 0.5 * (low.y + high.y)};
}

double reach_from(Point centre, const std::vector<SurfacePoint>& points) {
  double reach = 0.0;
  for (const auto& q : points) reach = std::max({reach, std::abs(q.p.x - centre.x), std::abs(q.p.y - centre.y)});
  return reach;
}

/// Nearness to the truth's walls, from a distance field read between its cells.
class Nearness {
 public:
  explicit Nearness(const OccupancyGrid& truth) : geometry_(truth.geometry()) {
    cv::Mat1b open(truth.height(), truth.width());
    for (std::size_t i = 0; i < truth.size(); ++i)
      open.data[i] = truth[i] == CellState::kOccupied ? std::uint8_t{0} : std::uint8_t{1};
    cv::distanceTransform(open, distance_, cv::DIST_L2, cv::DIST_MASK_PRECISE);
  }
  double operator()(Point p) const {
    const double fx = (p.x - geometry_.origin.x) / geometry_.resolution - 0.5;
    const double fy = (p.y - geometry_.origin.y) / geometry_.resolution - 0.5;
    const int x = static_cast<int>(std::floor(fx)), y = static_cast<int>(std::floor(fy));
    if (x < 0 || y < 0 || x + 1 >= geometry_.width || y + 1 >= geometry_.height) return 0.0;
    const double u = fx - x, v = fy - y;
    const double d = (1 - v) * ((1 - u) * distance_(y, x) + u * distance_(y, x + 1)) +
                     v * ((1 - u) * distance_(y + 1, x) + u * distance_(y + 1, x + 1));
    const double in_sigmas = d * geometry_.resolution / kSigma;
    return std::exp(-0.5 * in_sigmas * in_sigmas);
  }
  double mean(const std::vector<SurfacePoint>& points, const Pose2& T) const {
    double sum = 0.0;
    for (const auto& q : points) sum += (*this)(T * q.p);
    return sum / static_cast<double>(points.size());
  }

 private:
  GridGeometry geometry_;
  cv::Mat1f distance_;
};

/// Hill climbing with halved steps, down to a millimetre.
Pose2 refined(const Nearness& nearness, const std::vector<SurfacePoint>& points, double reach, Pose2 T) {
  double best = nearness.mean(points, T);
  for (double step = 0.16; step > 1e-3;) {
    const Pose2 before = T;
    const double turn = step / std::max(1.0, reach);
    for (const Pose2& d : {Pose2{step, 0, 0}, Pose2{-step, 0, 0}, Pose2{0, step, 0}, Pose2{0, -step, 0},
                           Pose2{0, 0, turn}, Pose2{0, 0, -turn}}) {
      const Pose2 tried{T.x + d.x, T.y + d.y, wrap_angle(T.theta + d.theta)};
      const double score = nearness.mean(points, tried);
      if (score > best) best = score, T = tried;
    }
    if (T == before) step *= 0.5;
  }
  return T;
}

}  // namespace

std::optional<MapAlignment> align_map(const OccupancyGrid& map, const OccupancyGrid& truth) {
  std::vector<SurfacePoint> ours = walls(map);
  const std::vector<SurfacePoint> theirs = walls(truth);
  if (ours.empty() || theirs.empty()) return std::nullopt;
  // The map turns about its own middle, so that a small turn is a small motion.
  const Point centre = middle(ours);
  const Pose2 T_map_middle{centre.x, centre.y, 0.0};
  for (auto& q : ours) q = inverse(T_map_middle) * q;
  const double reach = reach_from({}, ours);
  const Nearness nearness(truth);
  double cell = std::max(0.5 * kSearchCell, map.geometry().resolution);
  auto fine = thinned(ours, cell);
  while (fine.size() > kMostPoints) fine = thinned(fine, cell *= 1.5);

  MapAlignment result;
  Pose2 best = T_map_middle;
  result.score = nearness.mean(fine, best);
  const auto consider = [&](const std::optional<SearchHit>& hit) {
    if (!hit) return;
    const Pose2 T = refined(nearness, fine, reach, hit->T_map_robot);
    const double score = nearness.mean(fine, T);
    if (score > result.score) best = T, result.score = score, result.found = true;
  };
  const double search_cell = std::max(kSearchCell, truth.geometry().resolution);
  const auto coarse = thinned(fine, 2.0 * search_cell);
  const CorrelativeMatcher matcher(thinned(theirs, 0.5 * search_cell), search_cell, 7);
  consider(matcher.best(coarse, {T_map_middle, kNearM, kNearRad}, 0.1));
  const Point truth_centre = middle(theirs);
  const SearchWindow everywhere{{truth_centre.x, truth_centre.y, 0.0}, reach_from(truth_centre, theirs) + search_cell,
                                kPi};
  if (result.score < kGoodEnough) consider(matcher.best(coarse, everywhere, 0.15));
  if (const auto other = matcher.best(coarse, everywhere, 0.5 * result.score, best))
    result.rival = nearness.mean(fine, refined(nearness, fine, reach, other->T_map_robot));
  result.T_truth_map = best * inverse(T_map_middle);
  return result;
}

}  // namespace outrider::slam_glue
