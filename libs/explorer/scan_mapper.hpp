#pragma once

#include <memory>

#include "explorer/explorer.hpp"

namespace outrider::explorer {

/// A robot's map of record in lidar runs: slam_glue's GridMapper on MRPT's occupancy grid.
std::unique_ptr<ScanMapper> make_scan_mapper(const GridGeometry& geometry, const RobotSpec& spec);

}  // namespace outrider::explorer
