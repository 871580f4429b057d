#include "slam_glue/slam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "slam_glue/graph_slam.hpp"
#include "slam_glue/localizer.hpp"
#include "slam_glue/map_building.hpp"
#include "slam_glue/scan_odometry.hpp"
#include "slam_glue/session_merge.hpp"
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

/// Where a log's scans were taken, in the frame of the first (or as logged).
SlamResult localize(const LogReader& reader, const SlamOptions& options, const SlamProgressCallback& progress,
                    bool& interrupted, std::optional<SessionGraph>& graph) {
  const auto localizer = make_localizer(options);
  SlamResult result;
  result.log = reader.info();
  GrowthWatch watch;
  ScanOdometry scan_odometry;
  const bool as_logged = options.method == "odometry", own_wheels = options.method == "graph";
  reader.read([&](LogEntry entry, double fraction) {
    // Wheels alone lead ICP and the particle filter astray: see ScanOdometry.
    if (!as_logged && !own_wheels) entry.odometry = scan_odometry.add(entry);
    localizer->add(entry);
    watch.see(entry.odometry, localizer->keyframes());
    result.trajectory.push_back({entry.scan.t, {}});
    result.sensor_z = entry.scan.sensor_z;
    interrupted = progress && !progress({fraction, result.trajectory.size()});
    return !interrupted;
  });
  result.scans = result.trajectory.size();
  localizer->finish();
  result.keyframes = localizer->keyframes();
  const std::vector<Pose2> poses = localizer->poses();
  for (std::size_t i = 0; i < poses.size(); ++i) result.trajectory[i].pose = poses[i];
  graph = localizer->take_graph();
  constexpr double kTooLong = 15.0;  // keyframes come every metre or so
  if (!as_logged && watch.longest_m() > kTooLong)
    result.warnings.push_back(
        fmt::format("the SLAM's map did not grow over {:.0f} m of the way: scans no longer match it, "
                    "poses there are odometry; try another method",
                    watch.longest_m()));
  if (!result.log.has_odometry) result.warnings.emplace_back("the log holds no odometry");
  return result;
}

/// Logs of one time are played together; logs of different days side by side, each from its first scan.
void set_clocks(std::vector<SlamResult>& logs) {
  double first = logs[0].log.first_t;
  bool together = true;
  for (const SlamResult& a : logs) {
    first = std::min(first, a.log.first_t);
    together = together && std::any_of(logs.begin(), logs.end(), [&](const SlamResult& b) {
                 return logs.size() == 1 || (&a != &b && a.log.first_t < b.log.last_t && b.log.first_t < a.log.last_t);
               });
  }
  for (SlamResult& log : logs) log.clock_s = together ? first : log.log.first_t;
}

/// Puts every log where its start is known to be; without a start the first scan is the origin, or as logged.
void apply_starts(std::vector<SlamResult>& logs, std::vector<SessionGraph>& graphs, const TeamOptions& team) {
  for (std::size_t s = 0; s < logs.size() && s < team.starts.size(); ++s) {
    if (logs[s].trajectory.empty()) continue;
    const Pose2 T = team.starts[s] * inverse(logs[s].trajectory.front().pose);
    for (TimedPose& p : logs[s].trajectory) p.pose = T * p.pose;
    for (Pose2& pose : graphs[s].graph.poses) pose = T * pose;
  }
}

/// One pose graph of all logs; moves their trajectories.
void join(std::vector<SessionGraph> graphs, bool starts_known, TeamSlamResult& result) {
  JointGraph joint(std::move(graphs));
  const std::vector<Pose2> before = joint.graph.poses;
  result.merges = merge_sessions(joint, starts_known);
  for (std::size_t s = 0; s < result.logs.size(); ++s) {
    joint.carry(s, before, result.logs[s].trajectory);
    if (s == 0) continue;
    result.logs[s].in_team_map = result.merges[s - 1].accepted;
    result.merges[s - 1].T_map_start = result.logs[s].trajectory.front().pose;
  }
  result.closures = records(joint.graph, joint.closures);
}

}  // namespace

TeamSlamResult run_slam(std::span<const std::filesystem::path> logs, const SlamOptions& options,
                        const TeamOptions& team, const SlamProgressCallback& progress) {
  make_localizer(options);  // an unknown method stops here, before any log is read
  std::vector<LogReader> readers;
  for (const auto& log : logs) readers.emplace_back(log);
  TeamSlamResult result;
  std::vector<SessionGraph> graphs;
  constexpr double kLocalizing = 0.9;  // its share of the work; the rest is joining and the maps
  std::size_t scans = 0;
  for (std::size_t s = 0; s < readers.size() && !result.interrupted; ++s) {
    std::optional<SessionGraph> graph;
    const auto part = [&](const SlamProgress& p) {
      const double all = (static_cast<double>(s) + p.fraction) / static_cast<double>(readers.size());
      return !progress || progress({kLocalizing * all, scans + p.scans});
    };
    result.logs.push_back(localize(readers[s], options, part, result.interrupted, graph));
    scans += result.logs.back().scans;
    if (!graph && readers.size() > 1) graph = session_graph(readers[s], result.logs[s].trajectory, options.max_range_m);
    graphs.push_back(graph ? std::move(*graph) : SessionGraph{});
  }
  while (readers.size() > result.logs.size()) readers.pop_back();  // interrupted
  set_clocks(result.logs);
  apply_starts(result.logs, graphs, team);
  join(std::move(graphs), !team.unknown_starts, result);
  for (SlamResult& log : result.logs) log.path_m = path_length(log.trajectory);
  build_maps(readers, options, result);
  if (progress) progress({1.0, scans});
  return result;
}

}  // namespace outrider::slam_glue
