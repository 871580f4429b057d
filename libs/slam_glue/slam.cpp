#include "slam_glue/slam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "slam_glue/localizer.hpp"
#include "slam_glue/map_building.hpp"
#include "slam_glue/scan_odometry.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::slam_glue {
namespace {

/// Poses as logged.
class OdometryLocalizer : public Localizer {
 public:
  void add(const LogEntry& entry) override { poses_.push_back(entry.odometry); }
  std::vector<Pose2> poses() const override { return poses_; }
  std::size_t keyframes() override { return 0; }

 private:
  std::vector<Pose2> poses_;
};

std::unique_ptr<Localizer> make_localizer(const SlamOptions& options) {
  if (options.method == "graph") return make_graph(options.max_range_m);
  if (options.method == "icp") {
    IcpSettings settings;
    settings.max_range_m = options.max_range_m;
    return make_icp(settings);
  }
  if (options.method == "rbpf") {
    RbpfSettings settings;
    settings.max_range_m = options.max_range_m;
    settings.particles = options.particles;
    settings.seed = options.seed;
    return make_rbpf(settings);
  }
  if (options.method == "odometry") return std::make_unique<OdometryLocalizer>();
  std::vector<std::string> names;
  for (const auto& method : slam_methods()) names.push_back(method.name);
  throw InputError(fmt::format("unknown SLAM method '{}'{}", options.method, suggestion(options.method, names)));
}

double path_length(const std::vector<TimedPose>& trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    length += distance(trajectory[i - 1].pose.position(), trajectory[i].pose.position());
  return length;
}

/// MRPT's ICP gives up silently: it rejects every match, inserts nothing more, and drives on by odometry.
class GrowthWatch {
 public:
  void see(const Pose2& pose, std::size_t keyframes) {
    if (keyframes != keyframes_ || !last_) still_m_ = 0.0;
    if (last_) still_m_ += distance(last_->position(), pose.position());
    longest_m_ = std::max(longest_m_, still_m_);
    keyframes_ = keyframes;
    last_ = pose;
  }
  double longest_m() const { return longest_m_; }

 private:
  std::optional<Pose2> last_;
  std::size_t keyframes_ = 0;
  double still_m_ = 0.0, longest_m_ = 0.0;
};

}  // namespace

SlamResult run_slam(const std::filesystem::path& log, const SlamOptions& options,
                    const SlamProgressCallback& progress) {
  const auto localizer = make_localizer(options);
  const LogReader reader(log);
  SlamResult result;
  result.log = reader.info();
  constexpr double kLocalizing = 0.95;  // its share of the work; the rest is the map
  GrowthWatch watch;
  ScanOdometry scan_odometry;
  const bool as_logged = options.method == "odometry", graph = options.method == "graph";
  reader.read([&](LogEntry entry, double fraction) {
    // Wheels alone lead ICP and the particle filter astray: see ScanOdometry.
    if (!as_logged && !graph) entry.odometry = scan_odometry.add(entry);
    localizer->add(entry);
    watch.see(entry.odometry, localizer->keyframes());
    result.trajectory.push_back({entry.scan.t, {}});
    result.sensor_z = entry.scan.sensor_z;
    result.interrupted = progress && !progress({kLocalizing * fraction, result.trajectory.size()});
    return !result.interrupted;
  });
  result.scans = result.trajectory.size();
  localizer->finish();
  result.keyframes = localizer->keyframes();
  result.closures = localizer->closures();
  const std::vector<Pose2> poses = localizer->poses();
  const Pose2 T_map_slam = options.start ? *options.start * inverse(poses.front()) : Pose2{};
  for (std::size_t i = 0; i < poses.size(); ++i) result.trajectory[i].pose = T_map_slam * poses[i];
  result.path_m = path_length(result.trajectory);
  constexpr double kTooLong = 15.0;  // keyframes come every metre or so
  if (!as_logged && watch.longest_m() > kTooLong)
    result.warnings.push_back(
        fmt::format("the SLAM's map did not grow over {:.0f} m of the way: scans no longer match it, "
                    "poses there are odometry; try another method",
                    watch.longest_m()));
  if (!result.log.has_odometry) result.warnings.push_back("the log holds no odometry");
  build_map(reader, options, result);
  if (progress) progress({1.0, result.scans});
  return result;
}

}  // namespace outrider::slam_glue
