#pragma once
// Logs -> trajectory and map, through MRPT's SLAM.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "slam_glue/consistency.hpp"
#include "slam_glue/grid_mapper.hpp"
#include "slam_glue/logs.hpp"

namespace outrider::slam_glue {

struct SlamOptions {
  std::string method = "graph";  ///< one of slam_methods()
  double resolution = 0.05;    ///< of the published map [m]
  double max_range_m = 30.0;   ///< echoes from farther away are not used [m]
  std::uint64_t seed = 1;      ///< of the particle filter
  int particles = 10;          ///< of the particle filter
  std::optional<Pose2> start;  ///< T_map_robot at the first scan; default: the origin, or as logged for "odometry"
};

struct SlamProgress {
  double fraction = 0.0;  ///< of the whole job, in [0, 1]
  std::size_t scans = 0;  ///< localised so far
};
using SlamProgressCallback = std::function<bool(const SlamProgress&)>;  ///< false interrupts the run

/// A place seen before, or what looked like one.
struct ClosureRecord {
  double t_from = 0.0, t_to = 0.0;  ///< of the earlier and the later scan [s]
  Pose2 T_from_to;                  ///< as matched
  double residual_m = 0.0, residual_deg = 0.0;  ///< of the final trajectory against T_from_to
  double share = 0.0;      ///< of the later visit's points that lie on what the earlier one saw
  double agreement = 0.0;  ///< of the points that both visits could judge, the share that both saw alike
  bool accepted = false;
  std::string why;  ///< not believed because
};

struct SlamResult {
  LogInfo log;
  std::size_t scans = 0;              ///< localised; all of the log's, unless interrupted
  double path_m = 0.0;                ///< length of the trajectory [m]
  std::vector<TimedPose> trajectory;  ///< one pose a scan, T_map_robot, in the order of the log
  std::size_t keyframes = 0;          ///< scans that the SLAM put into its own map; 0 for "odometry"
  std::vector<ClosureRecord> closures;  ///< in the order of t_to; "graph" only
  std::vector<std::string> warnings;  ///< what a person should know before trusting the map
  bool interrupted = false;
  std::shared_ptr<const GridMapper> mapper;  ///< the published map, never null; mapper->states() is the grid
  double playback_step_s = 1.0;
  Grid<std::uint16_t> known_since;  ///< playback step at which the cell became known, 65535 = never
  double sensor_z = 0.0;            ///< height of the scan plane [m]
  SelfConsistency consistency;      ///< of the published map with a sample of the scans
};

/// Runs SLAM over one log and rebuilds the map along the final trajectory. Deterministic for equal input, options and
/// binary. Throws InputError for bad logs and unknown methods. Sets MRPT's process-wide clock and this thread's MRPT
/// random generator. O(scans * points of a scan * log(points of the map)).
SlamResult run_slam(const std::filesystem::path& log, const SlamOptions& options,
                    const SlamProgressCallback& progress = {});

struct SlamMethod {
  std::string name;
  std::string description;
};
/// In the order of `outrider list slam`.
std::vector<SlamMethod> slam_methods();

}  // namespace outrider::slam_glue
