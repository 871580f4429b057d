#pragma once
// A run's map beside the true one.

#include <string>

#include "report/run_record.hpp"

namespace outrider::app {

/// Lays the map onto the true one, for runs whose map has a frame of its own. Lives in the maps module.
void set_truth(OccupancyGrid truth, report::RunRecord& record);

/// How good the map is, in lines to read; "" when no truth is known.
std::string quality_lines(const report::Json& result);

}  // namespace outrider::app
