#pragma once
// Trajectories on a plan, for benches: a drawing in the page, without scripts.

#include <span>
#include <string>
#include <vector>

#include "world/geometry.hpp"

namespace outrider::report {

struct ChartPath {
  std::string label;
  std::vector<Point> points;  ///< [m], in the order driven
};

/// An SVG of paths in a rectangle from `low` to `high` [m], y up, a dot where each begins. `title` stands above it.
std::string path_chart(const std::string& title, Point low, Point high, std::span<const ChartPath> paths);

}  // namespace outrider::report
