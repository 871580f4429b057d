#pragma once
// The file of a sweep: which of explore's settings are fixed, and which take every value of a list.

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "explore.hpp"

namespace outrider::app {

using Settings = std::vector<std::pair<std::string, std::string>>;  ///< explore's long flags, and "world"; an
                                                                  ///< empty value is explore's default

struct SweepPlan {
  Settings base;
  std::vector<std::pair<std::string, std::vector<std::string>>> axes;  ///< in the order of the file
  std::string compare;                                                 ///< the axis whose values are tested in pairs
  std::vector<std::uint64_t> seeds{1};
};

/// Reads `base: {setting: value}`, `axes: {setting: [values]}`, `compare: setting`, `seeds: N or [list]` (docs/sweeps.md).
/// Throws InputError naming file, line and key.
SweepPlan read_sweep_file(const std::filesystem::path& path);

/// Explore's options from settings, through explore's own command line. Throws InputError.
struct ResolvedSettings {
  ExploreOptions options;
  std::string text;  ///< every option, the defaults too: what a run's id is made of
};
ResolvedSettings resolve(const Settings& settings);

}  // namespace outrider::app
