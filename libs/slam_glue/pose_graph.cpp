#include "slam_glue/pose_graph.hpp"

#include <ceres/ceres.h>

#include <Eigen/Cholesky>
#include <array>

namespace outrider::slam_glue {
namespace {

/// Whitened residual of one edge, with its derivatives.
class EdgeCost : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit EdgeCost(const PoseEdge& edge) : T_(edge.T_from_to) {
    // A little is added: an information matrix of a corridor is singular.
    const Eigen::Matrix3d information = edge.information + 1e-3 * Eigen::Matrix3d::Identity();
    root_ = information.llt().matrixU();
  }
  bool Evaluate(double const* const* nodes, double* residuals, double** jacobians) const override {
    const double *a = nodes[0], *b = nodes[1];
    const double c = std::cos(a[2]), s = std::sin(a[2]), dx = b[0] - a[0], dy = b[1] - a[1];
    const Eigen::Vector3d e{c * dx + s * dy - T_.x, -s * dx + c * dy - T_.y, wrap_angle(b[2] - a[2] - T_.theta)};
    Eigen::Map<Eigen::Vector3d>(residuals, 3) = root_ * e;
    using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    if (jacobians && jacobians[0]) {
      Eigen::Matrix3d J;
      J << -c, -s, -s * dx + c * dy, s, -c, -c * dx - s * dy, 0, 0, -1;
      Eigen::Map<RowMajor>(jacobians[0], 3, 3) = root_ * J;
    }
    if (jacobians && jacobians[1]) {
      Eigen::Matrix3d J;
      J << c, s, 0, -s, c, 0, 0, 0, 1;
      Eigen::Map<RowMajor>(jacobians[1], 3, 3) = root_ * J;
    }
    return true;
  }

 private:
  Pose2 T_;
  Eigen::Matrix3d root_;
};

}  // namespace

Pose2 residual(const PoseEdge& edge, std::span<const Pose2> nodes) {
  const Pose2 T = inverse(nodes[edge.from]) * nodes[edge.to];
  return {T.x - edge.T_from_to.x, T.y - edge.T_from_to.y, wrap_angle(T.theta - edge.T_from_to.theta)};
}

double chi_squared(const PoseEdge& edge, std::span<const Pose2> nodes) {
  const Pose2 r = residual(edge, nodes);
  const Eigen::Vector3d e{r.x, r.y, r.theta};
  return e.dot(edge.information * e);
}

void optimise(std::span<Pose2> nodes, std::span<const PoseEdge> edges, std::span<const std::size_t> fixed,
              double kernel) {
  std::vector<std::array<double, 3>> x(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) x[i] = {nodes[i].x, nodes[i].y, nodes[i].theta};
  ceres::Problem problem;
  for (const PoseEdge& edge : edges) {
    ceres::LossFunction* loss = edge.robust ? new ceres::CauchyLoss(kernel) : nullptr;
    problem.AddResidualBlock(new EdgeCost(edge), loss, x[edge.from].data(), x[edge.to].data());
  }
  for (const std::size_t i : fixed)
    if (problem.HasParameterBlock(x[i].data())) problem.SetParameterBlockConstant(x[i].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.num_threads = 1;
  options.max_num_iterations = 30;
  options.function_tolerance = 1e-5;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = {x[i][0], x[i][1], wrap_angle(x[i][2])};
}

}  // namespace outrider::slam_glue
