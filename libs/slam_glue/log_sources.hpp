#pragma once
// Internal: the formats behind LogReader.

#include <filesystem>
#include <memory>

#include "slam_glue/logs.hpp"

namespace outrider::slam_glue {

/// No laser has more beams; a larger count is damage, and is refused before memory is asked for.
inline constexpr std::size_t kMostBeams = 10'000;

std::unique_ptr<LogReader::Source> open_carmen(const std::filesystem::path& file);
std::unique_ptr<LogReader::Source> open_rawlog(const std::filesystem::path& file);

}  // namespace outrider::slam_glue
