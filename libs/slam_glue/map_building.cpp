#include "slam_glue/map_building.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "world/error.hpp"

namespace outrider::slam_glue {
namespace {

constexpr double kMostMapCells = 400e6;
constexpr std::uint16_t kNever = std::numeric_limits<std::uint16_t>::max();

/// Calls visit(scan, T_map_robot, index) for every localised scan.
template <class Visit>
void for_each_posed_scan(const LogReader& reader, const SlamResult& result, Visit&& visit) {
  std::size_t i = 0;
  reader.read([&](const LogEntry& entry, double) {
    visit(entry.scan, result.trajectory[i].pose, i);
    return ++i < result.scans;
  });
}

/// No-echo beams of a long-range scanner are as often dark, glassy or too near as they are free: they clear nothing.
double no_echo_range(const LaserScan& scan) {
  constexpr double kShortRange = 20.0;
  return scan.range_max <= kShortRange ? scan.range_max : 0.0;
}

/// Everything that was seen: a box that grows.
class Bounds {
 public:
  void include(Point p) {
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y)};
    high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y)};
  }
  void include(const LaserScan& scan, const Pose2& T_map_robot, double max_range_m) {
    const Pose2 T_map_sensor = T_map_robot * scan.T_robot_sensor;
    include(T_map_robot.position());
    for (std::size_t b = 0; b < scan.ranges.size(); ++b) {
      const double reach = scan.valid(b) ? std::min<double>(scan.ranges[b], max_range_m) : no_echo_range(scan);
      const double angle = T_map_sensor.theta + scan.angle(b);
      include({T_map_sensor.x + reach * std::cos(angle), T_map_sensor.y + reach * std::sin(angle)});
    }
  }
  /// The smallest grid, aligned with multiples of the resolution, that holds it.
  GridGeometry grid(double res) const {
    constexpr int kMargin = 4;  // cells of unknown around the map
    const double x0 = std::floor(low_.x / res) - kMargin, y0 = std::floor(low_.y / res) - kMargin;
    const double width = std::floor(high_.x / res) + kMargin + 1 - x0,
                 height = std::floor(high_.y / res) + kMargin + 1 - y0;
    if (!(width * height <= kMostMapCells))
      throw InputError(fmt::format("a map of {:.0f} x {:.0f} cells is too large; give a coarser resolution than {} m",
                                   width, height, res));
    return {res, {x0 * res, y0 * res}, static_cast<int>(width), static_cast<int>(height)};
  }

 private:
  Point low_{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point high_{-low_.x, -low_.y};
};

/// One map under construction.
class MapBuilder {
 public:
  MapBuilder(const GridGeometry& geometry, double max_range_m) : geometry_(geometry) {
    options_.max_range_m = max_range_m;
    built_.known_since = Grid<std::uint16_t>(geometry, kNever);
  }
  void add(const LaserScan& scan, const Pose2& T_map_robot, double t, double step_s) {
    if (!mapper_) {
      options_.no_echo_range_m = no_echo_range(scan);
      mapper_ = std::make_shared<GridMapper>(geometry_, options_);
    }
    changed_.clear();
    mapper_->insert(scan, T_map_robot, changed_);
    const auto step = static_cast<std::uint16_t>(t / step_s);
    for (const std::uint32_t cell : changed_) built_.known_since[cell] = std::min(built_.known_since[cell], step);
  }
  BuiltMap finish(const ConsistencyCheck& check) {
    if (!mapper_) mapper_ = std::make_shared<GridMapper>(geometry_, options_);
    built_.consistency = check.result(mapper_->states());
    built_.mapper = std::move(mapper_);
    return std::move(built_);
  }

 private:
  GridGeometry geometry_;
  MapperOptions options_;
  std::shared_ptr<GridMapper> mapper_;
  std::vector<std::uint32_t> changed_;
  BuiltMap built_;
};

/// How long the longest playback is, in steps that fit into 16 bits.
double playback_step(const TeamSlamResult& result) {
  double longest = 0.0;
  for (const SlamResult& log : result.logs)
    for (const TimedPose& p : log.trajectory) longest = std::max(longest, p.t - log.clock_s);
  constexpr double kMostSteps = 60'000.0;
  return std::max(1.0, std::ceil(longest / kMostSteps));
}

}  // namespace

void build_maps(std::span<const LogReader> readers, const SlamOptions& options, TeamSlamResult& result) {
  result.playback_step_s = playback_step(result);
  constexpr std::size_t kSample = 400;  // scans of a log that judge the maps
  Bounds together;
  std::vector<Bounds> alone(readers.size());
  ConsistencyCheck team_check(options.max_range_m);
  std::vector<ConsistencyCheck> checks(readers.size(), team_check);
  for (std::size_t s = 0; s < readers.size(); ++s) {
    const SlamResult& log = result.logs[s];
    const std::size_t stride = std::max<std::size_t>(1, log.scans / kSample);
    for_each_posed_scan(readers[s], log, [&](const LaserScan& scan, const Pose2& T_map_robot, std::size_t i) {
      (log.in_team_map ? together : alone[s]).include(scan, T_map_robot, options.max_range_m);
      if (i % stride != 0) return;
      checks[s].add(scan, T_map_robot);
      if (log.in_team_map) team_check.add(scan, T_map_robot);
    });
  }
  const GridGeometry geometry = together.grid(options.resolution);
  MapBuilder team(geometry, options.max_range_m);
  const bool single = readers.size() == 1;  // its map is the team's
  for (std::size_t s = 0; s < readers.size(); ++s) {
    SlamResult& log = result.logs[s];
    MapBuilder own(log.in_team_map ? geometry : alone[s].grid(options.resolution), options.max_range_m);
    for_each_posed_scan(readers[s], log, [&](const LaserScan& scan, const Pose2& T_map_robot, std::size_t i) {
      const double t = log.trajectory[i].t - log.clock_s;
      if (log.in_team_map) team.add(scan, T_map_robot, t, result.playback_step_s);
      if (!single) own.add(scan, T_map_robot, t, result.playback_step_s);
    });
    if (!single) log.map = own.finish(checks[s]);
  }
  result.team = team.finish(team_check);
  if (single) result.logs[0].map = result.team;
}

}  // namespace outrider::slam_glue
