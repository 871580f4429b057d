// Apart from the methods themselves: a program that only lists them need not load MRPT.

#include "slam_glue/slam.hpp"

namespace outrider::slam_glue {

std::vector<SlamMethod> slam_methods() {
  return {{"graph", "point-to-line scan matching, checked loop closures, pose graph (Ceres)"},
          {"icp", "scan matching against a growing points map (MRPT CMetricMapBuilderICP)"},
          {"rbpf", "Rao-Blackwellised particle filter with scan matching (MRPT CMetricMapBuilderRBPF)"},
          {"odometry", "poses as logged; mapping only"}};
}

}  // namespace outrider::slam_glue
