#include "slam_glue/point_matcher.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace outrider::slam_glue {
namespace {

constexpr double kCell = 0.1;          // of the table [m]
constexpr double kFinalReach = 0.12;   // pairs of the last iterations are nearer than this [m],
constexpr double kNoiseReach = 2.5, kMostFinalReach = 0.2;  // or so many standard deviations of the noise
constexpr double kShrink = 0.7;        // of the pairs' reach, each iteration
constexpr int kMostIterations = 20;
constexpr double kConvergedM = 1e-4, kConvergedRad = 1e-5;
constexpr double kSameFacing = 0.5;    // cosine between the normals of a pair
constexpr double kKernel = 0.05;       // scale of the Cauchy weight [m]
constexpr double kIndependent = 40.0;  // points of one scan err together: a scan is worth at most so many
constexpr double kOpen = 0.03;         // smallest mean squared cosine that still binds a direction

struct Sums {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double weight = 0.0, squares = 0.0;
  int pairs = 0;
};

Sums accumulate(const PointMap& map, std::span<const SurfacePoint> scan, const Pose2& T, double reach) {
  Sums sums;
  const double c = std::cos(T.theta), s = std::sin(T.theta);
  for (const SurfacePoint& q : scan) {
    const Point arm{c * q.p.x - s * q.p.y, s * q.p.x + c * q.p.y};
    const Point p{T.x + arm.x, T.y + arm.y};
    const SurfacePoint* m = map.near(p);
    if (!m) continue;
    const double dx = p.x - m->p.x, dy = p.y - m->p.y;
    const double r = m->normal.x * dx + m->normal.y * dy;
    const double along = m->normal.x * dy - m->normal.y * dx;
    if (std::abs(r) > reach || std::abs(along) > reach + kCell) continue;
    if (q.has_normal()) {
      const Point normal{c * q.normal.x - s * q.normal.y, s * q.normal.x + c * q.normal.y};
      if (normal.x * m->normal.x + normal.y * m->normal.y < kSameFacing) continue;
    }
    const double w = 1.0 / (1.0 + r * r / (kKernel * kKernel));
    const Eigen::Vector3d J{m->normal.x, m->normal.y, m->normal.y * arm.x - m->normal.x * arm.y};
    sums.H += w * J * J.transpose();
    sums.b += w * r * J;
    sums.weight += w;
    sums.squares += r * r;
    ++sums.pairs;
  }
  return sums;
}

/// Information of the match: scaled to what the scan is worth, and nothing along an open direction.
void fill_information(const Sums& sums, std::size_t points, double noise_m, PointMatch& match) {
  match.share = points == 0 ? 0.0 : static_cast<double>(sums.pairs) / static_cast<double>(points);
  match.rms_m = sums.pairs == 0 ? 0.0 : std::sqrt(sums.squares / sums.pairs);
  if (sums.pairs < 10) return;
  const double worth = std::min<double>(kIndependent, sums.pairs) / sums.weight / (noise_m * noise_m);
  Eigen::Matrix3d H = sums.H;
  const double xx = H(0, 0) / sums.weight, yy = H(1, 1) / sums.weight, xy = H(0, 1) / sums.weight;
  const double smallest = 0.5 * (xx + yy) - std::hypot(0.5 * (xx - yy), xy);
  match.bound = smallest > kOpen;
  if (!match.bound) {
    const double across = 0.5 * std::atan2(2.0 * xy, xx - yy);
    const Eigen::Vector3d open{-std::sin(across), std::cos(across), 0.0};
    const Eigen::Matrix3d project = Eigen::Matrix3d::Identity() - open * open.transpose();
    H = project * H * project;
  }
  match.information = worth * H;
  if (!match.bound) return;
  const Eigen::Vector3d step = (sums.H + 1e-6 * Eigen::Matrix3d::Identity()).ldlt().solve(-sums.b);
  const Pose2& T = match.T_map_robot;
  match.T_scan_only = {T.x + step.x(), T.y + step.y(), wrap_angle(T.theta + step.z())};
}

}  // namespace

PointMap::PointMap(std::vector<SurfacePoint> points) : points_(std::move(points)) {
  std::erase_if(points_, [](const SurfacePoint& q) { return !q.has_normal(); });
  if (points_.empty()) return;
  Point low = points_.front().p, high = low;
  for (const auto& q : points_) {
    low = {std::min(low.x, q.p.x), std::min(low.y, q.p.y)};
    high = {std::max(high.x, q.p.x), std::max(high.y, q.p.y)};
  }
  constexpr int kReachCells = static_cast<int>(kReach / kCell);
  origin_ = {low.x - (kReachCells + 1) * kCell, low.y - (kReachCells + 1) * kCell};
  width_ = static_cast<int>((high.x - origin_.x) / kCell) + kReachCells + 2;
  height_ = static_cast<int>((high.y - origin_.y) / kCell) + kReachCells + 2;
  const std::size_t cells = static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_);
  nearest_.assign(cells, -1);
  std::vector<float> squared(cells, std::numeric_limits<float>::max());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const double fx = (points_[i].p.x - origin_.x) / kCell, fy = (points_[i].p.y - origin_.y) / kCell;
    const int cx = static_cast<int>(fx), cy = static_cast<int>(fy);
    for (int y = cy - kReachCells; y <= cy + kReachCells; ++y)
      for (int x = cx - kReachCells; x <= cx + kReachCells; ++x) {
        const double dx = x + 0.5 - fx, dy = y + 0.5 - fy;
        const auto d = static_cast<float>(dx * dx + dy * dy);
        const std::size_t cell = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
        if (d >= squared[cell]) continue;
        squared[cell] = d;
        nearest_[cell] = static_cast<std::int32_t>(i);
      }
  }
}

const SurfacePoint* PointMap::near(Point p) const {
  const double x = (p.x - origin_.x) / kCell, y = (p.y - origin_.y) / kCell;
  if (!(x >= 0.0 && y >= 0.0 && x < width_ && y < height_)) return nullptr;
  const std::int32_t i =
      nearest_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x)];
  return i < 0 ? nullptr : &points_[static_cast<std::size_t>(i)];
}

PointMatch match_points(const PointMap& map, std::span<const SurfacePoint> scan, const Pose2& start, double noise_m,
                        const std::optional<PosePrior>& prior) {
  PointMatch match{start, start};
  Pose2& T = match.T_map_robot;
  if (map.empty()) return match;
  const double scale_all = kIndependent / (noise_m * noise_m);
  const double final_reach = std::clamp(kNoiseReach * noise_m, kFinalReach, kMostFinalReach);
  double reach = PointMap::kReach;
  for (int i = 0; i < kMostIterations; ++i, reach = std::max(final_reach, kShrink * reach)) {
    const Sums sums = accumulate(map, scan, T, reach);
    if (sums.pairs < 5) break;
    const double scale = scale_all / std::max(sums.weight, kIndependent);
    // A trace of damping keeps the solution where neither the surfaces nor the prior say anything.
    Eigen::Matrix3d H = scale * sums.H + Eigen::Vector3d(1.0, 1.0, 1.0).asDiagonal().toDenseMatrix();
    Eigen::Vector3d b = scale * sums.b;
    if (prior) {
      H += prior->information;
      b += prior->information *
           Eigen::Vector3d(T.x - prior->mean.x, T.y - prior->mean.y, wrap_angle(T.theta - prior->mean.theta));
    }
    const Eigen::Vector3d step = H.ldlt().solve(-b);
    T = {T.x + step.x(), T.y + step.y(), wrap_angle(T.theta + step.z())};
    const bool still = std::hypot(step.x(), step.y()) < kConvergedM && std::abs(step.z()) < kConvergedRad;
    if (still && reach <= final_reach) break;
  }
  match.T_scan_only = T;
  fill_information(accumulate(map, scan, T, final_reach), scan.size(), noise_m, match);
  return match;
}

}  // namespace outrider::slam_glue
