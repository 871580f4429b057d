#pragma once
// Internal: the text formats behind load_map.

#include <filesystem>

#include "slam_glue/map_files.hpp"

namespace outrider::slam_glue {

/// More cells than any map here has; stops absurd headers before memory is asked for.
inline constexpr std::uint64_t kMostCells = 400'000'000;

LoadedMap load_ascii(const std::filesystem::path& file, double resolution);
/// Beesoft's .dat[.gz]: header with the resolution in cm, then P(free) or -1, column by column. Origin at (0, 0).
OccupancyGrid load_beesoft(const std::filesystem::path& file);
OccupancyGrid load_moving_ai(const std::filesystem::path& file, double resolution);

}  // namespace outrider::slam_glue
