// The record and the result of `outrider replay`.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "replay.hpp"
#include "slam_glue/evaluation.hpp"

namespace outrider::app {
namespace {

using report::Json;
using slam_glue::SlamResult;
using slam_glue::TeamSlamResult;

Json pose_json(const Pose2& T) { return {T.x, T.y, T.theta}; }

Json spread_json(const slam_glue::ErrorStatistics& s) {
  return {{"mean", s.mean}, {"std", s.std}, {"median", s.median}, {"max", s.max}};
}

Json error_json(const slam_glue::ErrorStatistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std}, {"min", s.min}, {"max", s.max}};
}

/// Every loop closure, believed or not; times count from the first scan of each log.
Json closures_json(const TeamSlamResult& slam) {
  Json list = Json::array();
  const bool team = slam.logs.size() > 1;
  for (const auto& c : slam.closures) {
    Json line{{"t_from", c.t_from - slam.logs[c.log_from].log.first_t}, {"t_to", c.t_to - slam.logs[c.log_to].log.first_t},
              {"transform", pose_json(c.T_from_to)}, {"residual_m", c.residual_m}, {"residual_deg", c.residual_deg},
              {"share", c.share}, {"agreement", c.agreement}, {"accepted", c.accepted}, {"why", c.why}};
    if (team) line["robots"] = {robot_name(c.log_from), robot_name(c.log_to)};
    list.push_back(std::move(line));
  }
  return list;
}

Json slam_json(const TeamSlamResult& slam, const std::string& method) {
  std::vector<double> metres, degrees;
  for (const auto& c : slam.closures)
    if (c.accepted) metres.push_back(c.residual_m), degrees.push_back(c.residual_deg);
  const std::size_t accepted = metres.size();
  std::size_t keyframes = 0;
  for (const SlamResult& log : slam.logs) keyframes += log.keyframes;
  Json json{{"method", method}, {"loop_closures", accepted}, {"refused", slam.closures.size() - accepted},
            {"keyframes", keyframes}};
  if (accepted > 0) {
    json["closure_residual_m"] = spread_json(slam_glue::statistics(metres));
    json["closure_residual_deg"] = spread_json(slam_glue::statistics(degrees));
  }
  json["closures"] = closures_json(slam);
  return json;
}

Json merge_json(const TeamSlamResult& slam) {
  Json list = Json::array();
  for (const auto& m : slam.merges)
    list.push_back({{"robot", robot_name(m.log)}, {"transform", pose_json(m.T_map_start)}, {"score", m.agreement},
                    {"accepted", m.accepted}, {"why", m.why}, {"hit_ratio", m.hit_ratio},
                    {"conflict", m.agreement > 0.0 ? 1.0 - m.agreement : 0.0}, {"overlap_walls_m2", m.overlap_m2},
                    {"landmarks_m2", m.landmarks_m2}, {"missing", m.missing},
                    {"places", m.places}, {"closures", m.closures}, {"rival", m.rival}});
  return list;
}

report::RobotRecord robot_record(const ReplayOptions& o, SlamResult& log, std::size_t index,
                                 const GridGeometry& geometry, bool single) {
  report::RobotRecord robot;
  robot.spec.name = robot_name(index);
  robot.spec.range = o.slam.max_range_m;
  if (!log.trajectory.empty()) robot.spec.start = log.trajectory.front().pose;
  robot.trajectory = std::move(log.trajectory);
  robot.clock_s = log.clock_s;
  robot.in_team_frame = log.in_team_map;
  robot.seen = BitGrid(geometry);
  const OccupancyGrid& map = log.map.mapper->states();
  for (std::size_t i = 0; log.in_team_map && i < map.size(); ++i)
    if (map[i] != CellState::kUnknown) robot.seen.insert(i);
  if (!single) robot.map = map;
  return robot;
}

/// Who was first to see each free cell of the team's map, and when: the timeline, and each robot's share.
void fill_timeline(const TeamSlamResult& slam, const std::vector<double>& ends_s, report::RunRecord& record) {
  const std::size_t n = slam.logs.size();
  const double last_s = *std::max_element(ends_s.begin(), ends_s.end()), cell = record.map.geometry().cell_area();
  const auto steps = static_cast<std::size_t>(last_s / slam.playback_step_s) + 2;
  std::vector<std::vector<double>> news(n, std::vector<double>(steps, 0.0));
  double whole = 0.0;
  for (std::size_t i = 0; i < record.map.size(); ++i) {
    std::size_t who = 0;
    for (std::size_t s = 0; s < n; ++s) {
      if (!slam.logs[s].in_team_map) continue;
      const std::uint16_t since = slam.logs[s].map.known_since[i];
      if (since < record.known_since[i]) record.known_since[i] = since, who = s;
    }
    if (record.map[i] != CellState::kFree) continue;
    whole += cell;
    record.robots[who].first_seen_m2 += cell;
    news[who][std::min<std::size_t>(record.known_since[i], steps - 1)] += cell;
  }
  std::vector<double> so_far(n, 0.0);
  double all = 0.0;
  for (std::size_t k = 0; k < steps; ++k) {
    for (std::size_t s = 0; s < n; ++s) so_far[s] += news[s][k], all += news[s][k];
    record.timeline.push_back({std::min(last_s, static_cast<double>(k) * slam.playback_step_s),
                               whole > 0.0 ? all / whole : 0.0, all, so_far});
  }
}

}  // namespace

std::string robot_name(std::size_t log) { return fmt::format("robot{}", log + 1); }

report::RunRecord replay_record(const ReplayOptions& o, TeamSlamResult&& slam) {
  report::RunRecord record;
  record.verb = "replay";
  record.map = slam.team.mapper->states();
  record.playback_step_s = slam.playback_step_s;
  record.known_since = Grid<std::uint16_t>(record.map.geometry(), report::kNeverKnown);
  std::vector<double> ends_s;
  for (std::size_t s = 0; s < slam.logs.size(); ++s) {
    SlamResult& log = slam.logs[s];
    ends_s.push_back(log.trajectory.empty() ? 0.0 : log.log.last_t - log.clock_s);
    record.robots.push_back(robot_record(o, log, s, record.map.geometry(), slam.logs.size() == 1));
  }
  fill_timeline(slam, ends_s, record);
  return record;
}

report::Json replay_result(const TeamSlamResult& slam, const std::string& method) {
  std::size_t scans = 0;
  double duration_s = 0.0;
  Json path = Json::object(), warnings = Json::array();
  for (std::size_t s = 0; s < slam.logs.size(); ++s) {
    const SlamResult& log = slam.logs[s];
    scans += log.scans;
    duration_s = std::max(duration_s, log.log.last_t - log.clock_s);
    path[robot_name(s)] = log.path_m;
    for (const auto& w : log.warnings)
      warnings.push_back(slam.logs.size() > 1 ? fmt::format("{}: {}", robot_name(s), w) : w);
  }
  const auto& c = slam.team.consistency;
  Json result{{"status", slam.interrupted ? "interrupted" : "mapped"}, {"scans", scans}, {"duration_s", duration_s},
              {"path_m", slam.logs.size() > 1 ? path : Json(slam.logs[0].path_m)}, {"slam", slam_json(slam, method)},
              {"self_consistency", {{"scans", c.scans}, {"end_points_agree", c.end_points_agree},
                                    {"seen_through", c.seen_through}, {"doubled_walls", c.doubled_walls}}}};
  if (slam.logs.size() > 1) {
    result["merge"] = merge_json(slam);
    const bool all = std::all_of(slam.merges.begin(), slam.merges.end(), [](const auto& m) { return m.accepted; });
    if (!all && !slam.interrupted) result["status"] = "not_merged";
  }
  result["warnings"] = std::move(warnings);
  return result;
}

std::string evaluate_trajectories(const ReplayOptions& o, const TeamSlamResult& slam, Json& result) {
  // Logs that lie in the team's map are one trajectory to the evaluation, as long as their clocks do not overlap.
  std::vector<TimedPose> trajectory;
  for (const SlamResult& log : slam.logs)
    if (log.in_team_map) trajectory.insert(trajectory.end(), log.trajectory.begin(), log.trajectory.end());
  std::stable_sort(trajectory.begin(), trajectory.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
  std::string text;
  if (!o.relations.empty()) {
    const auto errors = slam_glue::evaluate_relations(trajectory, slam_glue::load_relations(o.relations));
    result["relations"] = {{"used", errors.used}, {"total", errors.total},
                           {"translation_m", spread_json(errors.translation_m)},
                           {"rotation_deg", spread_json(errors.rotation_deg)}};
    text += fmt::format("Relations: {} of {} used\n{}", errors.used, errors.total,
                        slam_glue::cartographer_lines(errors));
  }
  if (!o.ground_truth.empty()) {
    const auto pairs = slam_glue::associate(trajectory, slam_glue::load_trajectory(o.ground_truth));
    const auto ate = slam_glue::absolute_trajectory_error(pairs);
    const auto rpe = slam_glue::relative_pose_error(pairs);
    const auto& e = ate.error_m;
    result["ate_m"] = error_json(e);
    result["ate_m"]["matched"] = ate.matched;
    result["ate_m"]["association"] = pairs.interpolated ? "reference interpolated" : "nearest stamp";
    result["rpe"] = {{"steps", rpe.matched}, {"translation_m", error_json(rpe.translation_m)},
                     {"rotation_deg", error_json(rpe.rotation_deg)}};
    text += fmt::format("ATE: rmse {:.3f} m, mean {:.3f} m, median {:.3f} m, max {:.3f} m over {} poses{}\n", e.rmse,
                        e.mean, e.median, e.max, ate.matched, pairs.interpolated ? ", reference interpolated" : "");
    text += fmt::format("RPE: rmse {:.4f} m, {:.3f} deg between neighbouring poses\n", rpe.translation_m.rmse,
                        rpe.rotation_deg.rmse);
  }
  if (!text.empty() && text.back() != '\n') text += '\n';
  return text;
}

std::string merge_lines(const Json& result) {
  if (!result.contains("merge")) return "";
  std::string text;
  for (const Json& m : result["merge"]) {
    const Json& T = m["transform"];
    const std::string why = m["why"];
    text += m["accepted"].get<bool>()
                ? fmt::format("{} starts at x {:.2f} m, y {:.2f} m, {:.1f} deg: {} closures, {:.1f} % of the common space "
                              "agrees{}\n",
                              m["robot"].get<std::string>(), T[0].get<double>(), T[1].get<double>(),
                              T[2].get<double>() * 180.0 / kPi, m["closures"].get<int>(),
                              100.0 * m["score"].get<double>(), why.empty() ? "" : "; " + why)
                : fmt::format("{} is not merged: {}\n", m["robot"].get<std::string>(), why);
  }
  return text;
}

}  // namespace outrider::app
