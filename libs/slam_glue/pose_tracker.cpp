#include "slam_glue/pose_tracker.hpp"

#include "slam_glue/graph_slam.hpp"

namespace outrider::slam_glue {
namespace {

GraphSettings settings_for(double max_range_m) {
  GraphSettings settings;
  settings.max_range_m = max_range_m;
  return settings;
}

}  // namespace

struct PoseTracker::Impl {
  Pose2 start;
  GraphSlam slam;
};

PoseTracker::PoseTracker(const Pose2& start, double max_range_m)
    : impl_(new Impl{start, GraphSlam(settings_for(max_range_m))}) {}
PoseTracker::~PoseTracker() = default;
PoseTracker::PoseTracker(PoseTracker&&) noexcept = default;

Pose2 PoseTracker::add(const LaserScan& scan, const Pose2& odometry) {
  return impl_->start * impl_->slam.add(scan, odometry);
}

}  // namespace outrider::slam_glue
