#pragma once
// Internal: the published maps, rebuilt along the final trajectories.

#include <span>

#include "slam_glue/slam.hpp"

namespace outrider::slam_glue {

/// Reads the scans of the logs again, one reader a log, and fills playback_step_s, the team's map, and each log's own.
/// Throws InputError when the resolution asks for too large a map.
void build_maps(std::span<const LogReader> readers, const SlamOptions& options, TeamSlamResult& result);

}  // namespace outrider::slam_glue
