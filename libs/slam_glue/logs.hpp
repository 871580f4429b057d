#pragma once
// Laser logs, read as a stream: MRPT rawlogs (both forms) and CARMEN text logs, plain or gzip.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "world/geometry.hpp"
#include "world/scan.hpp"

namespace outrider::slam_glue {

/// One scan with the odometry that goes with it.
struct LogEntry {
  LaserScan scan;                    ///< scan.t is the log's own time stamp [s]
  Pose2 odometry;                    ///< T_odom_robot when the scan was taken
  std::optional<Pose2> logged_pose;  ///< T_map_robot, where the log holds corrected poses
};

struct LogInfo {
  std::string format;  ///< "carmen" or "rawlog"
  std::size_t scans = 0;
  double first_t = 0.0;  ///< [s]
  double last_t = 0.0;   ///< [s]
  bool has_odometry = false;
  double duration_s() const { return last_t - first_t; }
};

/// Called for every scan, in the order of the log, with the share of the log read so far; false stops the reading.
using ScanVisitor = std::function<bool(const LogEntry&, double fraction_read)>;

/// Reads the whole log strictly and keeps nothing. Throws InputError, with the file and the line or object, for a log
/// that is missing, truncated, corrupt, or holds no laser scan.
LogInfo inspect_log(const std::filesystem::path& file);

/// Streams the log. The same errors as inspect_log, though thrown as they are met. The log is read twice; memory does
/// not grow with it.
void read_log(const std::filesystem::path& file, const ScanVisitor& on_scan);

}  // namespace outrider::slam_glue
