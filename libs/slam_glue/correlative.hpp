#pragma once
// Internal: exhaustive scan matching by branch and bound (Olson 2009; Hess et al. 2016).

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "slam_glue/surface_points.hpp"

namespace outrider::slam_glue {

/// The poses that are tried: a square of positions and an arc of headings.
struct SearchWindow {
  Pose2 centre;
  double shift_m = 1.0;  ///< half the square's side
  double turn_rad = 0.3;  ///< half the arc; kPi tries all headings
  /// Standard deviations of what is believed beforehand; the centre is preferred. 0: no preference.
  double sigma_m = 0.0, sigma_rad = 0.0;
};

struct SearchHit {
  Pose2 T_map_robot;
  double score = 0.0;  ///< mean nearness of the scan's points to a point of the map, 0..1, less the doubt of the pose
};

/// A likelihood field with a pyramid of maxima above it, so that a whole block of positions is bounded by one look.
class CorrelativeMatcher {
 public:
  /// O(area / resolution^2 * levels).
  CorrelativeMatcher(std::span<const SurfacePoint> map, double resolution_m, int levels);

  /// The best pose of the window with a score above `least_score`; poses within `apart_m` and `apart_rad` of `excluded`
  /// are not tried. Exact on its lattice: resolution in x and y, a fine step in heading.
  std::optional<SearchHit> best(std::span<const SurfacePoint> scan, const SearchWindow& window, double least_score,
                                const std::optional<Pose2>& excluded = std::nullopt) const;

  static constexpr double kApartM = 0.7, kApartRad = 0.25;

 private:
  struct Level {
    int span = 1;                      ///< maxima over span x span cells to the upper right
    std::vector<std::uint8_t> values;  ///< (width + span - 1) x (height + span - 1), first cell at -(span - 1)
    int width = 0, height = 0;
  };
  struct Search;
  static Level maxima_above(const Level& below);

  double resolution_ = 0.05;
  Point origin_;
  int width_ = 0, height_ = 0;
  std::vector<Level> levels_;
};

}  // namespace outrider::slam_glue
