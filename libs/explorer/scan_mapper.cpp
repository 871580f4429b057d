#include "explorer/scan_mapper.hpp"

#include "slam_glue/grid_mapper.hpp"
#include "slam_glue/pose_tracker.hpp"

namespace outrider::explorer {
namespace {

class GridScanMapper : public ScanMapper {
 public:
  GridScanMapper(const GridGeometry& geometry, const slam_glue::MapperOptions& options) : mapper_(geometry, options) {}
  void insert(const PosedScan& scan, std::vector<std::uint32_t>& changed) override {
    mapper_.insert(scan.scan, scan.T_map_robot, changed);
  }
  const OccupancyGrid& states() const override { return mapper_.states(); }

 private:
  slam_glue::GridMapper mapper_;
};

}  // namespace

std::unique_ptr<ScanMapper> make_scan_mapper(const GridGeometry& geometry, const RobotSpec& spec) {
  slam_glue::MapperOptions options;
  options.max_range_m = spec.range;
  return std::make_unique<GridScanMapper>(geometry, options);
}

PoseTracking make_pose_tracking(const RobotSpec& spec) {
  const auto tracker = std::make_shared<slam_glue::PoseTracker>(spec.start, spec.range);
  return [tracker](const LaserScan& scan, const Pose2& T_odom_robot) { return tracker->add(scan, T_odom_robot); };
}

}  // namespace outrider::explorer
