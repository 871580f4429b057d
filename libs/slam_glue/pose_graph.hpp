#pragma once
// Internal: least squares over relative poses (Ceres).

#include <Eigen/Core>
#include <span>
#include <vector>

#include "world/geometry.hpp"

namespace outrider::slam_glue {

/// "To was seen from `from` at T_from_to."
struct PoseEdge {
  std::size_t from = 0, to = 0;
  Pose2 T_from_to;
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();  ///< of (x, y, theta) in the frame of `from`
  bool robust = false;  ///< may be wrong: a large residual counts less (Cauchy kernel)
  bool blind = false;   ///< dead reckoning alone, while the scans matched nothing
};

/// T_from_to as measured minus as the nodes have it, in the frame of `from`.
Pose2 residual(const PoseEdge& edge, std::span<const Pose2> nodes);
/// Squared Mahalanobis length of the residual.
double chi_squared(const PoseEdge& edge, std::span<const Pose2> nodes);

constexpr double kKernel = 3.0;  ///< of the robust edges [standard deviations]

/// Moves the nodes, except those in `fixed`, to where the edges agree best; nodes without edges stay. Deterministic.
void optimise(std::span<Pose2> nodes, std::span<const PoseEdge> edges, std::span<const std::size_t> fixed,
              double kernel = kKernel);

}  // namespace outrider::slam_glue
