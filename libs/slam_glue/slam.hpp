#pragma once
// Logs -> trajectory and map, through MRPT's SLAM.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
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
};

struct SlamProgress {
  double fraction = 0.0;  ///< of the whole job, in [0, 1]
  std::size_t scans = 0;  ///< localised so far
};
using SlamProgressCallback = std::function<bool(const SlamProgress&)>;  ///< false interrupts the run

/// A place seen before, or what looked like one.
struct ClosureRecord {
  std::size_t log_from = 0, log_to = 0;
  double t_from = 0.0, t_to = 0.0;  ///< of the earlier and the later scan [s]
  Pose2 T_from_to;                  ///< as matched
  double residual_m = 0.0, residual_deg = 0.0;  ///< of the final trajectory against T_from_to
  double share = 0.0;      ///< of the later visit's points that lie on what the earlier one saw
  double agreement = 0.0;  ///< of the points that both visits could judge, the share that both saw alike
  bool accepted = false;
  std::string why;  ///< not believed because
};

/// A map built along final trajectories.
struct BuiltMap {
  std::shared_ptr<const GridMapper> mapper;  ///< mapper->states() is the grid
  Grid<std::uint16_t> known_since;  ///< playback step at which the cell became known, 65535 = never
  SelfConsistency consistency;      ///< of the map with a sample of the scans
};

/// One log's part.
struct SlamResult {
  LogInfo log;
  std::size_t scans = 0;              ///< localised; all of the log's, unless interrupted
  double path_m = 0.0;                ///< length of the trajectory [m]
  std::vector<TimedPose> trajectory;  ///< one pose a scan, T_map_robot, in the order of the log
  std::size_t keyframes = 0;          ///< scans that the SLAM put into its own map; 0 for "odometry"
  std::vector<std::string> warnings;  ///< what a person should know before trusting the map
  double sensor_z = 0.0;              ///< height of the scan plane [m]
  double clock_s = 0.0;               ///< stamp at time 0 of the playback [s]
  bool in_team_map = true;            ///< false: it could not be placed, and its poses are in a frame of their own
  BuiltMap map;                       ///< from this log alone; of the team's geometry when in the team's map
};

/// How a log came into the map of the first one.
struct MergeRecord {
  std::size_t log = 0;
  bool accepted = false;
  Pose2 T_map_start;         ///< of the robot at its first scan
  std::size_t places = 0;    ///< along the log that were found in the map, all at one placement
  double rival = 0.0;        ///< weight of the next best placement, relative to the best
  std::size_t closures = 0;  ///< between this log and the others
  double agreement = 0.0;    ///< of the points that both sides could judge, the share that both saw alike
  double hit_ratio = 0.0;    ///< of the points in common space, the share on a wall of the other side
  double overlap_m2 = 0.0;   ///< of walls that both saw
  double landmarks_m2 = 0.0; ///< of them, what pins the place down: lasting walls across the way along which it could slide
  double missing = 0.0;      ///< lasting walls that the other side looked through, as a share of these and the landmarks
  std::string why;           ///< not accepted because, or what to know of it
};

struct TeamSlamResult {
  std::vector<SlamResult> logs;         ///< in the order given
  std::vector<MergeRecord> merges;      ///< of every log but the first
  std::vector<ClosureRecord> closures;  ///< in the order of the later scan; "graph", and between logs
  BuiltMap team;                        ///< of all logs that are in the team's map
  double playback_step_s = 1.0;
  bool interrupted = false;
};

/// How several logs come together.
struct TeamOptions {
  std::vector<Pose2> starts;    ///< T_map_robot at the first scan of each log, where known; of the first log only, or all
  bool unknown_starts = false;  ///< find out; the map frame is that of the first log
};

/// Runs SLAM over each log, joins them in one pose graph, and builds the maps along the final trajectories.
/// Deterministic for equal input, options and binary. Throws InputError for bad logs and unknown methods. Sets MRPT's
/// process-wide clock and this thread's MRPT random generator. O(scans * points of a scan * log(points of the map)).
TeamSlamResult run_slam(std::span<const std::filesystem::path> logs, const SlamOptions& options,
                        const TeamOptions& team = {}, const SlamProgressCallback& progress = {});

struct SlamMethod {
  std::string name;
  std::string description;
};
/// In the order of `outrider list slam`.
std::vector<SlamMethod> slam_methods();

}  // namespace outrider::slam_glue
