#pragma once
// Where a map lies on another one of the same place.

#include <optional>

#include "world/grid.hpp"

namespace outrider::slam_glue {

struct MapAlignment {
  Pose2 T_truth_map;   ///< maps the map's frame into the truth's
  double score = 0.0;  ///< mean nearness of the map's walls to true walls, 0..1: exp(-d^2 / 2 sigma^2), sigma 0.15 m
  double rival = 0.0;  ///< the same of the best clearly different place; near `score` where the building repeats itself
  bool found = false;  ///< false: no place fits better than the frames as they are
};

/// Moves the walls of `map` onto those of `truth`: the frames as they are when the walls fit there, else an exhaustive
/// search over all positions and headings (branch and bound), then by small steps. Absent when one of the maps has no
/// wall. A second or so for a building.
std::optional<MapAlignment> align_map(const OccupancyGrid& map, const OccupancyGrid& truth);

}  // namespace outrider::slam_glue
