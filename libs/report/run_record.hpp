#pragma once
// Everything that a run leaves behind, in memory. The Explorer's mission and the replay fill it; the report room
// derives metrics from it and writes the run folder (docs/file-formats.md).

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "world/bit_grid.hpp"
#include "world/grid.hpp"
#include "world/robot.hpp"

namespace outrider::report {

using Json = nlohmann::ordered_json;

/// JSON text; bytes that are no UTF-8 (they may come in with a file name) are replaced, not refused.
inline std::string to_text(const Json& json, int indent = -1) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

/// One robot's part of a run.
struct RobotRecord {
  RobotSpec spec;                     ///< name, abilities, start
  std::vector<TimedPose> trajectory;  ///< as driven (T_map_robot), time ascending
  std::optional<OccupancyGrid> map;   ///< its own map at the end
  BitGrid seen;                       ///< where this robot's own sensor saw the cell; empty grid = unknown
  double first_seen_m2 = 0.0;         ///< area that this robot was the first of the team to see [m^2]
  bool in_team_frame = true;          ///< false: its trajectory and map could not be placed in the team's map
  double clock_s = 0.0;               ///< stamp of the trajectory at time 0 of the timeline [s]
};

struct TimelineRow {
  double time_s = 0.0;
  double explored_fraction = 0.0;  ///< of the reachable area; of the final area when no truth is known
  double explored_m2 = 0.0;
  std::vector<double> robot_m2;  ///< first_seen_m2 of each robot so far, team order
};

/// At which playback step each cell of the team's map became known.
inline constexpr std::uint16_t kNeverKnown = std::numeric_limits<std::uint16_t>::max();

struct RunRecord {
  std::string version;               ///< of the program, e.g. "0.1.0"
  std::string verb;                  ///< "explore", "replay"
  std::vector<std::string> command;  ///< argv of the run
  std::uint64_t seed = 1;
  Json world;               ///< {"name", "width_m", "height_m", "resolution_m", ...}; null in replay
  std::string coordinator;  ///< "" in replay
  std::string comms;
  Json configuration;  ///< every resolved setting, for "how to reproduce it"
  std::vector<RobotRecord> robots;
  OccupancyGrid map;  ///< the team's map
  std::optional<OccupancyGrid> truth;
  Pose2 T_truth_map;  ///< where the map lies on the truth
  Json alignment;     ///< how T_truth_map was found; null: map and truth share their frame
  double playback_step_s = 1.0;
  Grid<std::uint16_t> known_since;  ///< playback step, or kNeverKnown; same geometry as map, or empty
  std::vector<TimelineRow> timeline;
  std::vector<Json> events;  ///< {"t": s, "event": "...", ...}, time ascending
  Json result;               ///< fields of INTERFACE `result` that the run itself knows
  Json timing;               ///< wall-clock figures; the only part that differs between equal runs
};

}  // namespace outrider::report
