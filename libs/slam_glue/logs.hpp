#pragma once
// Laser logs, read as a stream: MRPT rawlogs (both forms) and CARMEN text logs, plain or gzip.

#include <filesystem>
#include <functional>
#include <memory>
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
  double first_t = 0.0;       ///< [s]
  double last_t = 0.0;        ///< [s]
  bool has_odometry = false;  ///< false: every odometry pose is the origin
  double duration_s() const { return last_t - first_t; }
};

/// Called for every scan, in the order of the log, with the share of the log read so far; false stops the reading.
using ScanVisitor = std::function<bool(const LogEntry&, double fraction_read)>;

/// A log that has been read once, strictly, from beginning to end, and can be streamed any number of times.
/// Memory does not grow with the log.
class LogReader {
 public:
  /// The format follows from the content. Throws InputError, with the file and the line or object, for a log that is
  /// missing, truncated, corrupt, or holds no laser scan.
  explicit LogReader(const std::filesystem::path& file);
  ~LogReader();
  LogReader(LogReader&&) noexcept;

  const LogInfo& info() const;
  void read(const ScanVisitor& on_scan) const;

  /// What each format implements.
  class Source {
   public:
    virtual ~Source() = default;
    virtual LogInfo inspect() = 0;  ///< reads everything; called once, first
    virtual void read(const std::function<bool(const LogEntry&)>& on_scan) const = 0;
  };

 private:
  std::unique_ptr<Source> source_;
  LogInfo info_;
};

/// LogReader(file).read(on_scan).
void read_log(const std::filesystem::path& file, const ScanVisitor& on_scan);

}  // namespace outrider::slam_glue
