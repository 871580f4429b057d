#pragma once
// What needs MRPT, OctoMap, Ceres or OpenCV, behind one door: a module (outrider_maps.so, beside the program) that is
// loaded when it is first asked for. Its shared libraries cost each process about 0.4 s and 70 MB; most verbs do
// without.


#include <filesystem>
#include <memory>

#include "context.hpp"
#include "explorer/explorer.hpp"
#include "explorer/localized_body.hpp"
#include "report/run_record.hpp"
#include "slam_glue/map_files.hpp"
#include "speed_works.hpp"

namespace outrider::app {

/// Verbs that live in the module, with what `outrider --help` says of them.
struct ModuleVerb {
  const char* name;
  const char* about;
};
inline constexpr ModuleVerb kReplay{"replay", "logs become a map, a trajectory and a report"};
inline constexpr ModuleVerb kMap{"map", "converts maps; --info describes one"};

class MapsModule {
 public:
  virtual ~MapsModule() = default;

  virtual void add_verbs(CLI::App& app, Context& ctx) const = 0;
  /// See slam_glue::load_map.
  virtual slam_glue::LoadedMap load_map(const std::filesystem::path& file,
                                        const slam_glue::MapLoadOptions& options) const = 0;
  /// Writes map.yaml, map.pgm, map.gridmap, robots/NAME/map.*, and map.bt if asked, into a run folder.
  virtual void write_maps(const report::RunRecord& record, const std::filesystem::path& folder, bool octomap) const = 0;
  /// See true_map.hpp.
  virtual void set_truth(OccupancyGrid truth, report::RunRecord& record) const = 0;
  /// See explorer::make_scan_mapper.
  virtual std::unique_ptr<explorer::ScanMapper> make_scan_mapper(const GridGeometry& geometry,
                                                                 const RobotSpec& spec) const = 0;
  /// See explorer::make_pose_tracking.
  virtual explorer::PoseTracking make_pose_tracking(const RobotSpec& spec) const = 0;
  /// What `bench speed` times; some references are OpenCV's.
  virtual std::vector<Work> speed_works() const = 0;
};

/// Loads the module at the first call. Throws std::runtime_error when it is not there. Thread-safe.
const MapsModule& maps_module();

}  // namespace outrider::app
