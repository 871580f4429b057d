#pragma once

#include <memory>

#include "explorer/explorer.hpp"
#include "explorer/localized_body.hpp"

namespace outrider::explorer {

/// A robot's map of record in lidar runs: slam_glue's GridMapper on MRPT's occupancy grid.
std::unique_ptr<ScanMapper> make_scan_mapper(const GridGeometry& geometry, const RobotSpec& spec);

/// Scan matching against the robot's own map: slam_glue's PoseTracker.
PoseTracking make_pose_tracking(const RobotSpec& spec);

}  // namespace outrider::explorer
