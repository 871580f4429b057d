// The module's side of the door.

#include "maps_module.hpp"

#include "explorer/scan_mapper.hpp"
#include "true_map.hpp"
#include "verbs.hpp"

namespace outrider::app {
namespace {

void write_map(const OccupancyGrid& map, const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  slam_glue::save_ros_map(map, folder / "map.yaml");
}

class Module : public MapsModule {
 public:
  void add_verbs(CLI::App& app, Context& ctx) const override {
    add_replay(app, ctx);
    add_map(app, ctx);
  }
  slam_glue::LoadedMap load_map(const std::filesystem::path& file,
                                const slam_glue::MapLoadOptions& options) const override {
    return slam_glue::load_map(file, options);
  }
  void write_maps(const report::RunRecord& record, const std::filesystem::path& folder, bool octomap) const override {
    write_map(record.map, folder);
    slam_glue::save_gridmap(record.map, folder / "map.gridmap");
    if (octomap) slam_glue::save_octomap(record.map, folder / "map.bt", 0.0);
    for (const report::RobotRecord& robot : record.robots)
      if (robot.map) write_map(*robot.map, folder / "robots" / robot.spec.name);
  }
  void set_truth(OccupancyGrid truth, report::RunRecord& record) const override {
    app::set_truth(std::move(truth), record);
  }
  std::unique_ptr<explorer::ScanMapper> make_scan_mapper(const GridGeometry& geometry,
                                                         const RobotSpec& spec) const override {
    return explorer::make_scan_mapper(geometry, spec);
  }
  explorer::PoseTracking make_pose_tracking(const RobotSpec& spec) const override {
    return explorer::make_pose_tracking(spec);
  }
  std::vector<Work> speed_works() const override { return app::speed_works(); }
};

}  // namespace
}  // namespace outrider::app

extern "C" const outrider::app::MapsModule* outrider_maps_module() {
  static const outrider::app::Module module;
  return &module;
}
