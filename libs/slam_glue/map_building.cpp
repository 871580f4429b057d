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

/// The smallest grid, aligned with multiples of the resolution, that holds the trajectory and everything seen from it.
/// A sample of the scans goes to `check` on the way.
GridGeometry bounds(const LogReader& reader, const SlamOptions& options, const SlamResult& result,
                    ConsistencyCheck& check) {
  constexpr std::size_t kSample = 400;  // scans
  const std::size_t stride = std::max<std::size_t>(1, result.scans / kSample);
  Point low{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  Point high{-low.x, -low.y};
  const auto include = [&](Point p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  };
  for_each_posed_scan(reader, result, [&](const LaserScan& scan, const Pose2& T_map_robot, std::size_t i) {
    if (i % stride == 0) check.add(scan, T_map_robot);
    const Pose2 T_map_sensor = T_map_robot * scan.T_robot_sensor;
    include(T_map_robot.position());
    for (std::size_t b = 0; b < scan.ranges.size(); ++b) {
      const double reach = scan.valid(b) ? std::min<double>(scan.ranges[b], options.max_range_m) : no_echo_range(scan);
      const double angle = T_map_sensor.theta + scan.angle(b);
      include({T_map_sensor.x + reach * std::cos(angle), T_map_sensor.y + reach * std::sin(angle)});
    }
  });
  const double res = options.resolution;
  constexpr int kMargin = 4;  // cells of unknown around the map
  const double x0 = std::floor(low.x / res) - kMargin, y0 = std::floor(low.y / res) - kMargin;
  const double width = std::floor(high.x / res) + kMargin + 1 - x0,
               height = std::floor(high.y / res) + kMargin + 1 - y0;
  if (!(width * height <= kMostMapCells))
    throw InputError(fmt::format("a map of {:.0f} x {:.0f} cells is too large; give a coarser resolution than {} m",
                                 width, height, res));
  return {res, {x0 * res, y0 * res}, static_cast<int>(width), static_cast<int>(height)};
}

}  // namespace

void build_map(const LogReader& reader, const SlamOptions& options, SlamResult& result) {
  ConsistencyCheck check(options.max_range_m);
  const GridGeometry geometry = bounds(reader, options, result, check);
  MapperOptions mapping;
  mapping.max_range_m = options.max_range_m;
  double t0 = std::numeric_limits<double>::infinity(), t1 = -t0;
  for (const TimedPose& p : result.trajectory) {
    t0 = std::min(t0, p.t);
    t1 = std::max(t1, p.t);
  }
  constexpr double kMostSteps = 60'000.0;  // of the playback: a step is a 16-bit number
  result.playback_step_s = std::max(1.0, std::ceil((t1 - t0) / kMostSteps));
  result.known_since = Grid<std::uint16_t>(geometry, kNever);
  std::shared_ptr<GridMapper> mapper;
  std::vector<std::uint32_t> changed;
  for_each_posed_scan(reader, result, [&](const LaserScan& scan, const Pose2& T_map_robot, std::size_t i) {
    if (!mapper) {
      mapping.no_echo_range_m = no_echo_range(scan);
      mapper = std::make_shared<GridMapper>(geometry, mapping);
    }
    changed.clear();
    mapper->insert(scan, T_map_robot, changed);
    const auto step = static_cast<std::uint16_t>((result.trajectory[i].t - t0) / result.playback_step_s);
    for (const std::uint32_t cell : changed) result.known_since[cell] = std::min(result.known_since[cell], step);
  });
  result.consistency = check.result(mapper->states());
  result.mapper = std::move(mapper);
}

}  // namespace outrider::slam_glue
