#pragma once
// Internal: the scans that a SLAM remembers, and what is known of where they were taken from.

#include <cstddef>
#include <span>
#include <vector>

#include "slam_glue/pose_graph.hpp"
#include "slam_glue/surface_points.hpp"
#include "world/scan.hpp"

namespace outrider::slam_glue {

struct Keyframe {
  std::size_t session = 0;  ///< which log or robot
  std::size_t index = 0;    ///< of the scan in its session
  double t = 0.0;           ///< [s]
  double path_m = 0.0;      ///< driven in its session before [m]
  LaserScan scan;
  std::vector<SurfacePoint> points;  ///< robot frame
  Point view;                        ///< middle of what it sees, robot frame

  /// Where an earlier visit shows the same the scan and its points are let go; the pose stays in the graph.
  void forget() {
    std::vector<float>().swap(scan.ranges);
    std::vector<SurfacePoint>().swap(points);
  }
  bool kept() const { return !scan.ranges.empty(); }
};

/// Makes a keyframe's points and view from its scan.
Keyframe make_keyframe(const LaserScan& scan, double max_range_m);

struct KeyframeGraph {
  std::vector<Keyframe> frames;
  std::vector<Pose2> poses;  ///< T_map_robot of every frame
  std::vector<PoseEdge> edges;

  std::size_t size() const { return frames.size(); }
  /// Frames of k's session from k - before to k + after.
  std::pair<std::size_t, std::size_t> neighbours(std::size_t k, std::size_t before, std::size_t after) const;
  /// Points of the frames [begin, end) in the frame of keyframe `of`.
  std::vector<SurfacePoint> gather(std::size_t begin, std::size_t end, std::size_t of) const;
};

/// How points fit what other scans saw: on a surface there, or in the middle of air they looked through.
struct Visibility {
  std::size_t agree = 0, conflict = 0, points = 0;
  double agreement() const {  ///< share of the judged points that agree
    return agree + conflict == 0 ? 0.0 : static_cast<double>(agree) / static_cast<double>(agree + conflict);
  }
  double coverage() const {  ///< share of all points that agree
    return points == 0 ? 0.0 : static_cast<double>(agree) / static_cast<double>(points);
  }
};

/// How far apart the surfaces of two scans may be and be one, and how much farther a beam must go to have gone through.
struct SightLimits {
  double near_m = 0.15, near_slope = 0.03;       ///< [m], and per metre of range: beams widen, walls are grazed
  double through_m = 0.4, through_slope = 0.03;  ///< likewise
  bool square = false;                           ///< through_m across the surface instead of along the beam
};

/// Judges points, given in the frame of keyframe `of`, by the scans of `frames`: a point agrees when some scan ends
/// near it, conflicts when none does and one passes through it. `agrees`: the verdict on each point. O(points *
/// frames).
Visibility judge(const KeyframeGraph& graph, std::span<const std::size_t> frames, std::size_t of,
                 std::span<const SurfacePoint> points, std::vector<bool>* agrees = nullptr);

/// How many scans see a point where it is, and how many look through it.
struct Sightings {
  int there = 0, through = 0;
};
/// Of every point, given in the frame of keyframe `of`, by the scans of `frames`. O(points * frames).
std::vector<Sightings> sightings(const KeyframeGraph& graph, std::span<const std::size_t> frames, std::size_t of,
                                 std::span<const SurfacePoint> points, const SightLimits& limits);

}  // namespace outrider::slam_glue
