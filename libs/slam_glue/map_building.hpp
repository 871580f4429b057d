#pragma once
// Internal: the published map, rebuilt along the final trajectory.

#include "slam_glue/slam.hpp"

namespace outrider::slam_glue {

/// Reads the first `result.scans` scans again and fills mapper, known_since and playback_step_s. Throws InputError when
/// the resolution asks for too large a map.
void build_map(const LogReader& reader, const SlamOptions& options, SlamResult& result);

}  // namespace outrider::slam_glue
