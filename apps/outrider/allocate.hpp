#pragma once
// What the files of `outrider allocate` share.

#include <filesystem>
#include <optional>
#include <string>

#include "context.hpp"
#include "explorer/allocation_run.hpp"
#include "explorer/mission_execution.hpp"
#include "report/mission_page.hpp"
#include "report/run_record.hpp"

namespace outrider::app {

struct AllocateOptions {
  std::filesystem::path mission;
  std::string map;  ///< a world to draw a mission on
  std::optional<double> resolution;
  int goals = 9, robots = 3;
  bool together = false;
  double radius = 0.0;  ///< [m]; 0: of the world's usual team
  std::string protocol = "dssa", initial = "empty", gains = "sum", comms = "ideal";
  double noc = 0.1;
  int starts = 16;
  bool return_home = false;
  bool execute = false;       ///< drive the mission in the lidar simulator
  double rendezvous_m = 5.0;  ///< [m]
};

/// A mission and, when there is one, the grid that its map was built from.
struct AllocateMission {
  decision::TopoMission mission;
  std::optional<OccupancyGrid> grid;
  std::string name;
  RobotSpec robot;  ///< what each robot is like
};

/// Reads the mission file or draws one. Throws InputError.
AllocateMission open_mission(const AllocateOptions& o, std::uint64_t seed);

/// The document of run.json.
report::Json allocate_json(const AllocateMission& m, const AllocateOptions& o, const explorer::AllocationResult& result,
                           const Context& ctx);
/// What became of the mission when it was driven.
report::Json execution_json(const AllocateMission& m, const explorer::ExecutionResult& run);
std::string execution_verdict(const AllocateMission& m, const explorer::ExecutionResult& run);
/// events.jsonl and trajectories/NAME.tum of a driven mission.
void write_execution(const AllocateMission& m, const explorer::ExecutionResult& run, const std::filesystem::path& folder);

std::string allocate_verdict(const AllocateMission& m, const AllocateOptions& o, const explorer::AllocationResult& result);

/// report.html; `run`: how it was driven, if it was.
std::string allocate_page(const AllocateMission& m, const AllocateOptions& o, const explorer::AllocationResult& result,
                          const explorer::ExecutionResult* run);

}  // namespace outrider::app
