#pragma once

#include "explorer/mission.hpp"
#include "report/run_record.hpp"

namespace outrider::app {

/// The run record of a finished mission: results and events as documented in docs/file-formats.md.
report::RunRecord mission_record(explorer::MissionResult&& result, const explorer::MissionSettings& settings,
                                 const OccupancyGrid& truth);

/// A line of events.jsonl. `robots` names them, in team order.
report::Json event_json(double t, const explorer::Event& event, const GridGeometry& geometry,
                        const std::vector<report::RobotRecord>& robots);

}  // namespace outrider::app
