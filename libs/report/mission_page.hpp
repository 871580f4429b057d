#pragma once
// The page of a multi-task mission: the topological map with the tours in colours, tables, curves. Plain data in, one
// self-contained page out.

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "report/table.hpp"
#include "world/grid.hpp"

namespace outrider::report {

struct MissionPlace {
  Point at;           ///< [m]
  std::string id;
  std::string about;  ///< shown on pointing at it
  int owner = -1;     ///< index of the tour that it is a goal of; -1: no goal
  bool goal = false;
  int order = 0;      ///< of the visit, from 1
};

struct MissionTour {
  std::string name;
  std::vector<Point> way;      ///< planned, waypoint by waypoint [m]
  std::vector<Point> driven;   ///< as driven; may be empty [m]
};

struct MissionPicture {
  const OccupancyGrid* map = nullptr;  ///< below everything; may be missing
  std::vector<MissionPlace> places;
  std::vector<std::vector<Point>> ways;
  std::vector<MissionTour> tours;
};

/// A drawing of its own (SVG), the same bytes for the same picture.
std::string mission_svg(const MissionPicture& picture);

/// Values over steps as an SVG curve with its axes labelled.
std::string curve_svg(const std::vector<std::pair<double, double>>& points, const std::string& x_label,
                      const std::string& y_label);

/// The whole page: title, one sentence, the picture, the curve, tables.
std::string mission_html(const std::string& title, const std::string& verdict, const MissionPicture& picture,
                         const std::string& curve, const std::vector<Table>& tables);

}  // namespace outrider::report
