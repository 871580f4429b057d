#pragma once

#include <filesystem>

#include "explorer/mission.hpp"
#include "report/run_record.hpp"

namespace outrider::app {

/// The run record of a finished mission: results and events as documented in docs/file-formats.md.
report::RunRecord mission_record(explorer::MissionResult&& result, const explorer::MissionSettings& settings,
                                 const OccupancyGrid& truth);

/// Writes what needs the map room into a run folder: map.yaml, map.pgm, map.gridmap, robots/NAME/map.*, map.bt if asked.
void write_maps(const report::RunRecord& record, const std::filesystem::path& folder, bool octomap);

}  // namespace outrider::app
