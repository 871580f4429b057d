#include "slam_glue/scan_odometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace outrider::slam_glue {
namespace {

constexpr double kCell = 0.05;   // of the field [m]
constexpr double kReach = 12.0;  // half the field's side [m]
constexpr int kSide = static_cast<int>(2.0 * kReach / kCell);
constexpr double kBlur = 0.08;  // standard deviation of the nearness [m]
constexpr int kBlurCells = 4;
constexpr double kDegree = kPi / 180.0;
constexpr double kNewReferenceM = 0.4, kNewReferenceRad = 12.0 * kDegree;
constexpr double kStillM = 2e-3, kStillRad = 2e-3;  // wheels that moved less have not moved
constexpr std::size_t kFewestPoints = 30;

double gauss(double cells) { return std::exp(-0.5 * (cells * cells) * (kCell * kCell) / (kBlur * kBlur)); }

Point to_field(Point p) { return {(p.x + kReach) / kCell, (p.y + kReach) / kCell}; }

}  // namespace

/// A lattice of poses around a guess, and how far from the guess the wheels may plausibly be.
struct ScanOdometry::Window {
  double turn = 0.0, turn_step = 0.0;    // [rad]
  double shift = 0.0, shift_step = 0.0;  // [m]
  double sigma_turn = 0.0, sigma_shift = 0.0;
  std::size_t stride = 1;  // uses every stride-th point
};

ScanOdometry::ScanOdometry() : field_(static_cast<std::size_t>(kSide) * kSide, 0) {}

void ScanOdometry::set_reference(const Pose2& pose) {
  reference_ = pose;
  std::fill(field_.begin(), field_.end(), std::uint8_t{0});
  for (const Point& p : points_) {
    const Point f = to_field(p);
    const int cx = static_cast<int>(std::floor(f.x)), cy = static_cast<int>(std::floor(f.y));
    if (cx < kBlurCells || cy < kBlurCells || cx >= kSide - kBlurCells || cy >= kSide - kBlurCells) continue;
    std::array<double, 2 * kBlurCells + 1> near_x{}, near_y{};
    for (int k = -kBlurCells; k <= kBlurCells; ++k) {
      near_x[static_cast<std::size_t>(k + kBlurCells)] = gauss(cx + k + 0.5 - f.x);
      near_y[static_cast<std::size_t>(k + kBlurCells)] = gauss(cy + k + 0.5 - f.y);
    }
    for (std::size_t j = 0; j < near_y.size(); ++j) {
      std::uint8_t* row = field_.data() + (cy - kBlurCells + static_cast<int>(j)) * kSide + cx - kBlurCells;
      for (std::size_t i = 0; i < near_x.size(); ++i)
        row[i] = std::max(row[i], static_cast<std::uint8_t>(255.0 * near_x[i] * near_y[j]));
    }
  }
}

/// Mean nearness of the current points to the reference scan, 0..1.
double ScanOdometry::score(const Pose2& T, std::size_t stride) const {
  const double c = std::cos(T.theta) / kCell, s = std::sin(T.theta) / kCell;
  const Point origin = to_field(T.position());
  int sum = 0, count = 0;
  for (std::size_t i = 0; i < points_.size(); i += stride, ++count) {
    const int x = static_cast<int>(origin.x + c * points_[i].x - s * points_[i].y);
    const int y = static_cast<int>(origin.y + s * points_[i].x + c * points_[i].y);
    if (static_cast<unsigned>(x) < kSide && static_cast<unsigned>(y) < kSide)
      sum += field_[static_cast<std::size_t>(y * kSide + x)];
  }
  return sum / (255.0 * std::max(count, 1));
}

Pose2 ScanOdometry::best(const Pose2& guess, const Window& w) const {
  Pose2 best_pose = guess;
  double best_score = -1e9;
  const int turns = static_cast<int>(std::round(w.turn / w.turn_step));
  const int shifts = static_cast<int>(std::round(w.shift / w.shift_step));
  for (int k = -turns; k <= turns; ++k) {
    for (int j = -shifts; j <= shifts; ++j) {
      for (int i = -shifts; i <= shifts; ++i) {
        const double dt = k * w.turn_step, dx = i * w.shift_step, dy = j * w.shift_step;
        const double doubt =
            dt * dt / (w.sigma_turn * w.sigma_turn) + (dx * dx + dy * dy) / (w.sigma_shift * w.sigma_shift);
        const Pose2 pose{guess.x + dx, guess.y + dy, guess.theta + dt};
        const double value = score(pose, w.stride) - 0.02 * doubt;
        if (value > best_score) {
          best_score = value;
          best_pose = pose;
        }
      }
    }
  }
  return best_pose;
}

Pose2 ScanOdometry::add(const LogEntry& entry) {
  const LaserScan& scan = entry.scan;
  points_.clear();
  for (std::size_t b = 0; b < scan.ranges.size(); ++b) {
    if (!scan.valid(b) || scan.ranges[b] > kReach) continue;
    const double r = scan.ranges[b], a = scan.angle(b);
    points_.push_back(scan.T_robot_sensor * Point{r * std::cos(a), r * std::sin(a)});
  }
  const Pose2 move = wheels_ ? inverse(*wheels_) * entry.odometry : Pose2{};
  const bool first = !wheels_;
  wheels_ = entry.odometry;
  if (first) pose_ = entry.odometry;
  const bool moved = std::hypot(move.x, move.y) > kStillM || std::abs(move.theta) > kStillRad;
  has_wheels_ = has_wheels_ || moved;
  pose_ = pose_ * move;
  if (first) set_reference(pose_);
  const bool still = has_wheels_ && !moved;  // without odometry, every scan may have moved
  if (first || still || points_.size() < kFewestPoints) return pose_;

  const std::size_t stride = std::max<std::size_t>(1, points_.size() / 80);
  const Pose2 guess = inverse(reference_) * pose_;
  const Window coarse{24 * kDegree, 1.5 * kDegree, 0.16, 0.08, 20 * kDegree, 0.25, stride};
  const Window fine{1.0 * kDegree, 0.5 * kDegree, 0.04, 0.04, 20 * kDegree, 0.25, std::max<std::size_t>(1, stride / 2)};
  const Pose2 T = best(best(guess, coarse), fine);
  pose_ = reference_ * T;
  if (std::hypot(T.x, T.y) > kNewReferenceM || std::abs(T.theta) > kNewReferenceRad) set_reference(pose_);
  return pose_;
}

}  // namespace outrider::slam_glue
