#include "sim/checks.hpp"

#include <fmt/format.h>

#include <cmath>

#include "world/error.hpp"

namespace outrider::sim {
namespace {

bool at_least(double value, double least) { return std::isfinite(value) && value >= least; }
bool positive(double value) { return std::isfinite(value) && value > 0.0; }

}  // namespace

void check_options(const SimOptions& options) {
  if (!positive(options.dt)) throw InputError(fmt::format("time step {}: expected a positive number of s", options.dt));
  if (options.lidar && !positive(options.scan_rate))
    throw InputError(fmt::format("scan rate {}: expected a positive number of Hz", options.scan_rate));
  if (!at_least(options.range_noise, 0.0))
    throw InputError(fmt::format("range noise {}: expected a number of m, 0 or more", options.range_noise));
}

void check_robot(const RobotSpec& robot, bool lidar) {
  const auto require = [&](bool ok, const char* key, double value, const char* expected) {
    if (!ok) throw InputError(fmt::format("robot '{}', {} {}: expected {}", robot.name, key, value, expected));
  };
  require(std::isfinite(robot.start.x), "start x", robot.start.x, "a finite number");
  require(std::isfinite(robot.start.y), "start y", robot.start.y, "a finite number");
  require(std::isfinite(robot.start.theta), "start theta", robot.start.theta, "a finite number");
  require(at_least(robot.speed, 0.0), "speed", robot.speed, "a number of m/s, 0 or more");
  require(at_least(robot.range, 0.0), "range", robot.range, "a number of m, 0 or more");
  require(at_least(robot.radius, 1e-3), "radius", robot.radius, "a number of m, 0.001 or more");
  require(!lidar || robot.beams >= 1, "beams", robot.beams, "1 or more");
  require(!lidar || positive(robot.fov), "fov", robot.fov, "a positive number of rad");
}

}  // namespace outrider::sim
