#pragma once
// A whole team in the simulator: robots, radio, faults, the referee who knows the truth, and the verdict.

#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "explorer/explorer.hpp"
#include "explorer/localized_body.hpp"
#include "link/ether.hpp"
#include "link/radio.hpp"
#include "sim/simulator.hpp"
#include "sim/world.hpp"
#include "world/bit_grid.hpp"

namespace outrider::explorer {

struct Fault {
  enum class Kind { kKill, kRevive, kSlow, kDeaf, kHear };
  Kind kind = Kind::kKill;
  RobotId robot = 0;
  double t = 0.0;        ///< [s]
  double factor = 1.0;   ///< of kSlow
};

struct MissionSettings {
  std::string coordinator = "daa";
  CoordinatorSettings coordination;
  ExplorerSettings explorer;
  sim::SimOptions sim;
  MapperFactory make_mapper;      ///< for sim.lidar, not used otherwise
  Localization localization = Localization::kPerfect;  ///< otherwise sim.lidar must be set
  OdometryNoise odometry;
  TrackingFactory make_tracking;  ///< for Localization::kSlam, not used otherwise
  double until = 1.0;             ///< stop when this fraction of the reachable area has been seen; 1: go on to the end
  double max_time_s = 0.0;        ///< 0: ten times what one slow robot would need to drive over everything
  std::vector<Fault> faults;      ///< time ascending
  link::RadioSpec radio;          ///< default: ideal
  bool record_events = true;
};

enum class MissionStatus { kExplored, kUnreachableLeft, kTimeout, kFailed, kInterrupted };
std::string to_string(MissionStatus status);

/// How far a robot was from where it believed itself to be.
struct LocalizationError {
  double rmse_m = 0.0, max_m = 0.0, last_m = 0.0;
};

struct MissionRobot {
  RobotSpec spec;
  std::vector<TimedPose> trajectory;
  OccupancyGrid map;
  BitGrid seen;
  double first_seen_m2 = 0.0;
  double path_m = 0.0;
  std::optional<LocalizationError> localization;  ///< absent: it knew
};

struct TimelinePoint {
  double time_s = 0.0;
  double explored_fraction = 0.0;
  double explored_m2 = 0.0;
  std::vector<double> robot_m2;
};

struct LoggedEvent {
  double t = 0.0;
  Event event;
};

struct MissionResult {
  MissionStatus status = MissionStatus::kFailed;
  double explored_fraction = 0.0;   ///< of the reachable area
  double reachable_m2 = 0.0;
  double time_s = 0.0;              ///< exploration: until the aim was reached, or nothing was left
  double mission_time_s = 0.0;      ///< with the way home, when asked for
  std::vector<std::pair<double, std::optional<double>>> time_to;  ///< fraction -> first time it was seen [s]
  std::vector<Left> left;
  std::vector<MissionRobot> robots;
  OccupancyGrid map;                ///< union of what the team knows
  Grid<std::uint16_t> known_since;  ///< playback step at which somebody first saw the cell; 65535 never
  double playback_step_s = 1.0;
  std::vector<TimelinePoint> timeline;
  std::vector<LoggedEvent> events;
  link::RadioCounters radio;
  std::uint64_t interactions = 0;   ///< how often two robots came closer than 1 m
  double interaction_s = 0.0;       ///< robot-seconds with another robot closer than 1 m
  std::uint64_t interactions_in_breaks = 0;  ///< of these, those that began while a break cut the two off
  double interaction_in_breaks_s = 0.0;      ///< of these, those near somebody whom a break cut off
  bool maps_equal = false;          ///< all living robots' maps were equal at the end
  std::vector<double> decision_ms;  ///< wall-clock time of every act(); the only part that differs between equal runs
};

/// The map with every unknown cell occupied: what bodies and sensors of the simulator meet.
OccupancyGrid solid_map(OccupancyGrid map);

/// Cells that the team's slimmest robot can drive over, with the margin of its body: what "explored" is measured
/// against. Reached from any start. 1 = reachable.
Grid<std::uint8_t> reachable_area(const OccupancyGrid& truth, const std::vector<RobotSpec>& team);

/// Called now and then: (simulated time, explored fraction). Returning false interrupts the run cleanly.
using MissionProgress = std::function<bool(double now_s, double explored_fraction)>;
/// Runs a mission to its end. Deterministic in everything but decision_ms. Throws InputError for impossible starts or
/// an unknown coordinator. `truth` is free or occupied everywhere (see solid_map).
MissionResult run_mission(const OccupancyGrid& truth, const std::vector<RobotSpec>& team,
                          const MissionSettings& settings, const MissionProgress& progress = {});

}  // namespace outrider::explorer
