#include "explorer/scan_mapper.hpp"

#include "slam_glue/grid_mapper.hpp"

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

}  // namespace outrider::explorer
