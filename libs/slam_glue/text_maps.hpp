#pragma once
// Internal: the two text formats behind load_map.

#include <filesystem>

#include "slam_glue/map_files.hpp"

namespace outrider::slam_glue {

/// More cells than any map here has; stops absurd headers before memory is asked for.
inline constexpr std::uint64_t kMostCells = 400'000'000;

LoadedMap load_ascii(const std::filesystem::path& file, double resolution);
OccupancyGrid load_moving_ai(const std::filesystem::path& file, double resolution);

}  // namespace outrider::slam_glue
