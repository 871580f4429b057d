#pragma once
// What `outrider replay` was asked for, and what its run leaves behind.

#include <filesystem>
#include <string>
#include <vector>

#include "report/run_record.hpp"
#include "slam_glue/slam.hpp"

namespace outrider::app {

struct ReplayOptions {
  std::vector<std::filesystem::path> logs;
  slam_glue::SlamOptions slam;
  slam_glue::TeamOptions team;
  std::filesystem::path relations, ground_truth, true_map;
  std::vector<std::string> starts;
};

/// The run record of the logs: a robot each, its own map, what became known when. Times count from the first scan.
report::RunRecord replay_record(const ReplayOptions& options, slam_glue::TeamSlamResult&& slam);

/// What the run itself reports.
report::Json replay_result(const slam_glue::TeamSlamResult& slam, const std::string& method);

/// Compares the trajectories with relations and ground truth, as asked for. Fills `result`; returns lines to read.
/// With several logs, those of one clock are compared together.
std::string evaluate_trajectories(const ReplayOptions& options, const slam_glue::TeamSlamResult& slam,
                                  report::Json& result);

/// How the logs came together, in lines to read.
std::string merge_lines(const report::Json& result);

/// robot1, robot2, ...
std::string robot_name(std::size_t log);

}  // namespace outrider::app
