#pragma once
// How good is a trajectory: relations (Kuemmerle et al. 2009) and absolute trajectory error (as evo computes it).

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

struct AteResult {
  std::size_t matched = 0;  ///< reference poses compared
  ErrorStatistics error_m;
  Pose2 T_reference_map;  ///< the rigid alignment that was applied
};

/// Absolute trajectory error after the best rigid alignment (Umeyama 1991, without scale). Each pose is matched with
/// the reference, interpolated at its time where that lies between two reference poses at most `max_gap_s` apart.
/// Throws InputError when fewer than two poses match.
AteResult absolute_trajectory_error(std::span<const TimedPose> trajectory, std::span<const TimedPose> reference,
                                    double max_gap_s = 1.0);

/// TUM (`t x y z qx qy qz qw`) or `t x y theta`, told apart by the number of columns; `#` starts a comment. Sorted by
/// time. Throws InputError with the line.
std::vector<TimedPose> load_trajectory(const std::filesystem::path& file);

/// TUM format; throws std::runtime_error when it cannot be written completely.
void save_tum(std::span<const TimedPose> trajectory, const std::filesystem::path& file);

}  // namespace outrider::slam_glue
