// MRPT's rawlogs. The stock readers report success on truncated, damaged and random files; this loop does not.

#include <fmt/format.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/obs/registerAllClasses.h>
#include <mrpt/serialization/CArchive.h>

#include <cmath>

#include "slam_glue/gzip.hpp"
#include "slam_glue/log_sources.hpp"
#include "world/error.hpp"

namespace outrider::slam_glue {
namespace {

using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CObservation2DRangeScan;

Pose2 to_pose(const mrpt::poses::CPose2D& p) { return {p.x(), p.y(), wrap_angle(p.phi())}; }

double to_seconds(mrpt::Clock::time_point t) { return t == INVALID_TIMESTAMP ? 0.0 : mrpt::Clock::toDouble(t); }

/// None for a scanner that does not lie in the plane of the floor (more than 5 degrees off).
std::optional<LaserScan> to_scan(const CObservation2DRangeScan& obs) {
  const auto& pose = obs.sensorPose;
  constexpr double kLevel = 5.0 * kPi / 180.0;
  const double roll = wrap_angle(pose.roll());
  const bool upside_down = std::abs(roll) > 0.5 * kPi;
  if (std::abs(upside_down ? kPi - std::abs(roll) : roll) > kLevel || std::abs(pose.pitch()) > kLevel)
    return std::nullopt;
  const std::size_t n = obs.getScanSize();
  LaserScan scan;
  scan.t = to_seconds(obs.timestamp);
  scan.range_max = obs.maxRange;
  scan.T_robot_sensor = {pose.x(), pose.y(), pose.yaw()};
  scan.sensor_z = pose.z();
  scan.angle_min = -0.5 * obs.aperture;
  scan.angle_increment = n > 1 ? obs.aperture / static_cast<double>(n - 1) : 0.0;
  if (obs.rightToLeft == upside_down) scan.angle_min *= -1.0, scan.angle_increment *= -1.0;
  scan.ranges.resize(n);
  for (std::size_t i = 0; i < n; ++i)
    scan.ranges[i] = obs.getScanRangeValidity(i) ? obs.getScanRange(i) : std::numeric_limits<float>::infinity();
  return scan;
}

class Rawlog : public LogReader::Source {
 public:
  explicit Rawlog(const std::filesystem::path& file) : file_(file), name_(file.string()) {
    mrpt::obs::registerAllClasses_mrpt_obs();  // the linker drops libmrpt-obs's own registration
  }

  LogInfo inspect() override {
    // The checksum first: MRPT may ask for any amount of memory when it meets a damaged count.
    if (!gzip_plain_size(file_)) throw InputError(fmt::format("{}: damaged or truncated gzip file", name_));
    LogInfo info{"rawlog", 0, 0.0, 0.0, false};
    read([&](const LogEntry& e) {
      if (info.scans++ == 0) info.first_t = e.scan.t;
      info.last_t = e.scan.t;
      info.has_odometry = info.has_odometry || e.odometry != Pose2{};
      return true;
    });
    return info;
  }

  void read(const std::function<bool(const LogEntry&)>& on_scan) const override {
    mrpt::io::CFileGZInputStream stream(name_);
    auto archive = mrpt::serialization::archiveFrom(stream);
    Pose2 odometry;
    for (std::size_t count = 1;; ++count) {
      const auto object = next_object(stream, archive, count);
      if (!object || !visit(*object, odometry, on_scan)) return;
    }
  }

 private:
  /// Null at the end of the log.
  mrpt::serialization::CSerializable::Ptr next_object(mrpt::io::CFileGZInputStream& stream,
                                                      mrpt::serialization::CArchive& archive, std::size_t count) const {
    const auto position = stream.getPosition();
    try {
      return archive.ReadObject();
    } catch (const mrpt::serialization::CExceptionEOF&) {
      if (stream.getPosition() == position && count > 1) return nullptr;
    } catch (const std::exception&) {  // MRPT's texts are back-traces of many lines
    }
    if (count == 1) throw InputError(fmt::format("{}: not an MRPT rawlog", name_));
    throw InputError(fmt::format("{}: object {} is truncated or damaged", name_, count));
  }

  /// `odometry` is the robot's pose by dead reckoning so far. Rawlogs come in two forms: (action, sensory frame) pairs,
  /// and single observations.
  bool visit(const mrpt::serialization::CSerializable& object, Pose2& odometry,
             const std::function<bool(const LogEntry&)>& on_scan) const {
    if (const auto* actions = dynamic_cast<const mrpt::obs::CActionCollection*>(&object)) {
      if (const auto move = actions->getActionByClass<CActionRobotMovement2D>())
        odometry = odometry * to_pose(move->poseChange->getMeanVal());
      return true;
    }
    if (const auto* frame = dynamic_cast<const mrpt::obs::CSensoryFrame*>(&object)) {
      for (const auto& observation : *frame)
        if (!visit_observation(*observation, odometry, on_scan)) return false;
      return true;
    }
    const auto* observation = dynamic_cast<const mrpt::obs::CObservation*>(&object);
    return observation == nullptr || visit_observation(*observation, odometry, on_scan);
  }

  bool visit_observation(const mrpt::obs::CObservation& observation, Pose2& odometry,
                         const std::function<bool(const LogEntry&)>& on_scan) const {
    if (const auto* wheels = dynamic_cast<const mrpt::obs::CObservationOdometry*>(&observation))
      odometry = to_pose(wheels->odometry);
    const auto* scan = dynamic_cast<const CObservation2DRangeScan*>(&observation);
    if (scan == nullptr) return true;
    if (scan->getScanSize() > kMostBeams)
      throw InputError(
          fmt::format("{}: a scan of {} beams; expected at most {}", name_, scan->getScanSize(), kMostBeams));
    auto converted = to_scan(*scan);
    return !converted || on_scan({std::move(*converted), odometry, std::nullopt});
  }

  std::filesystem::path file_;
  std::string name_;
};

}  // namespace

std::unique_ptr<LogReader::Source> open_rawlog(const std::filesystem::path& file) {
  return std::make_unique<Rawlog>(file);
}

}  // namespace outrider::slam_glue
