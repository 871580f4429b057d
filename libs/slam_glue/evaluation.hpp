#pragma once
// How good is a trajectory: relations (Kuemmerle et al. 2009), absolute and relative errors (as evo computes them).

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "world/geometry.hpp"

namespace outrider::slam_glue {

/// Of a list of errors; all zero for an empty list.
struct ErrorStatistics {
  double mean = 0.0, std = 0.0;  ///< std: of the population
  double rmse = 0.0, median = 0.0, min = 0.0, max = 0.0;
};
ErrorStatistics statistics(std::vector<double> errors);

/// What should have been measured between two moments: the pose of the robot at t2 in its frame at t1.
struct Relation {
  double t1 = 0.0, t2 = 0.0;  ///< [s]
  Pose2 T_1_2;
};

/// Lines `t1 t2 x y z roll pitch yaw`, [s], [m], [rad]. Throws InputError with the line.
std::vector<Relation> load_relations(const std::filesystem::path& file);

struct RelationErrors {
  std::size_t used = 0, total = 0;  ///< relations inside the trajectory's time, and all
  ErrorStatistics translation_m, rotation_deg;
  ErrorStatistics translation_sqr_m2, rotation_sqr_deg2;
};

/// Compares the trajectory (time ascending), interpolated between poses at most `max_gap_s` apart, with the relations.
RelationErrors evaluate_relations(std::span<const TimedPose> trajectory, std::span<const Relation> relations,
                                  double max_gap_s = 3.0);

/// The four lines that Cartographer's evaluation prints.
std::string cartographer_lines(const RelationErrors& errors);

/// Poses of a trajectory beside the reference's at the same moments.
struct PosePairs {
  std::vector<Pose2> ours, reference;
  bool interpolated = false;  ///< the reference between its stamps, because too few stamps are equal
};

/// As evo associates: each stamp of the shorter list with the nearest of the longer, at most `max_difference_s` away.
/// When that serves less than half of the shorter list, every pose of the trajectory is compared with the reference
/// interpolated between stamps at most `max_gap_s` apart. Throws InputError when fewer than two poses match.
PosePairs associate(std::span<const TimedPose> trajectory, std::span<const TimedPose> reference,
                    double max_difference_s = 0.01, double max_gap_s = 1.0);

struct AteResult {
  std::size_t matched = 0;  ///< poses compared
  ErrorStatistics error_m;
  Pose2 T_reference_map;  ///< the rigid alignment that was applied
};

/// Absolute trajectory error after the best rigid alignment (Umeyama 1991, without scale): `evo_ape ... -a`.
AteResult absolute_trajectory_error(const PosePairs& pairs);

/// Relative pose error between neighbouring poses: `evo_rpe` (translation part, and rotation angle).
struct RpeResult {
  std::size_t matched = 0;  ///< steps compared
  ErrorStatistics translation_m, rotation_deg;
};
RpeResult relative_pose_error(const PosePairs& pairs);

/// TUM (`t x y z qx qy qz qw`) or `t x y theta`, told apart by the number of columns; `#` starts a comment. Sorted by
/// time. Throws InputError with the line.
std::vector<TimedPose> load_trajectory(const std::filesystem::path& file);

/// TUM format; throws std::runtime_error when it cannot be written completely.
void save_tum(std::span<const TimedPose> trajectory, const std::filesystem::path& file);

}  // namespace outrider::slam_glue
