// `outrider replay`: a log becomes a map, a trajectory and a report.

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "maps_module.hpp"
#include "progress.hpp"
#include "replay_lcm.hpp"
#include "report/metrics.hpp"
#include "report/run_folder.hpp"
#include "slam_glue/evaluation.hpp"
#include "slam_glue/map_alignment.hpp"
#include "slam_glue/map_files.hpp"
#include "slam_glue/slam.hpp"
#include "verbs.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"
#include "world_source.hpp"

namespace outrider::app {
namespace {

using report::Json;

struct Options {
  std::vector<std::filesystem::path> logs;
  slam_glue::SlamOptions slam;
  std::filesystem::path relations, ground_truth, true_map;
  std::vector<std::string> starts;
  bool unknown_starts = false;
};

void check(Options& o) {
  std::vector<std::string> names;
  for (const auto& method : slam_glue::slam_methods()) names.push_back(method.name);
  if (std::find(names.begin(), names.end(), o.slam.method) == names.end())
    throw InputError(fmt::format("--slam: unknown method '{}'{}", o.slam.method, suggestion(o.slam.method, names)));
  if (o.logs.size() > 1 || o.unknown_starts)
    throw InputError("replay: merging several logs is not there yet; expected one LOG");
  if (o.starts.empty()) return;
  Pose2 start;
  char rest = 0;
  if (std::sscanf(o.starts.front().c_str(), "%lf,%lf,%lf%c", &start.x, &start.y, &start.theta, &rest) != 3)
    throw InputError(fmt::format("--start: expected \"x,y,theta\" in m and rad, not '{}'", o.starts.front()));
  o.slam.start = start;
}

Json statistics_json(const slam_glue::ErrorStatistics& s) {
  return {{"mean", s.mean}, {"std", s.std}, {"median", s.median}, {"max", s.max}};
}

Json error_json(const slam_glue::ErrorStatistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std}, {"min", s.min}, {"max", s.max}};
}

/// What the trajectory is worth: relations, ground truth. Filled into `result`; returns what a person should read.
std::string evaluate(const Options& o, const std::vector<TimedPose>& trajectory, Json& result) {
  std::string text;
  if (!o.relations.empty()) {
    const auto errors = slam_glue::evaluate_relations(trajectory, slam_glue::load_relations(o.relations));
    result["relations"] = {{"used", errors.used}, {"total", errors.total},
                           {"translation_m", statistics_json(errors.translation_m)},
                           {"rotation_deg", statistics_json(errors.rotation_deg)}};
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

/// The run record of one log: one robot, its map, what became known when. Times count from the first scan.
report::RunRecord replay_record(const Options& o, const slam_glue::SlamResult& slam) {
  report::RunRecord record;
  record.verb = "replay";
  record.map = slam.mapper->states();
  report::RobotRecord robot;
  robot.clock_s = slam.log.first_t;
  robot.spec.name = "robot1";
  robot.spec.range = o.slam.max_range_m;
  if (!slam.trajectory.empty()) robot.spec.start = slam.trajectory.front().pose;
  robot.trajectory = slam.trajectory;
  const auto& g = record.map.geometry();
  robot.seen = Grid<std::uint8_t>(g);
  const double last_s = slam.log.duration_s();
  std::vector<double> known_m2(static_cast<std::size_t>(last_s / slam.playback_step_s) + 2, 0.0);
  for (std::size_t i = 0; i < record.map.size(); ++i) {
    const bool known = record.map[i] != CellState::kUnknown;
    robot.seen[i] = known;
    if (!known || record.map[i] != CellState::kFree) continue;
    robot.first_seen_m2 += g.cell_area();
    known_m2[std::min<std::size_t>(slam.known_since[i], known_m2.size() - 1)] += g.cell_area();
  }
  double so_far = 0.0;
  for (std::size_t k = 0; k < known_m2.size(); ++k) {
    so_far += known_m2[k];
    record.timeline.push_back({std::min(last_s, static_cast<double>(k) * slam.playback_step_s),
                               robot.first_seen_m2 > 0.0 ? so_far / robot.first_seen_m2 : 0.0, so_far, {so_far}});
  }
  record.known_since = slam.known_since;
  record.playback_step_s = slam.playback_step_s;
  record.robots.push_back(std::move(robot));
  return record;
}

/// Lays the map onto the true one.
void set_truth(OccupancyGrid truth, report::RunRecord& record) {
  const auto alignment = slam_glue::align_map(record.map, truth);
  if (alignment) {
    const Pose2& T = alignment->T_truth_map;
    record.T_truth_map = T;
    record.alignment = {{"transform", {T.x, T.y, T.theta}}, {"score", alignment->score},
                        {"rival_score", alignment->rival}, {"moved", alignment->found}};
  }
  record.truth = std::move(truth);
}

/// The map beside the truth, in words.
std::string quality_lines(const Json& result) {
  if (!result.contains("map_quality")) return "";
  const Json& q = result["map_quality"];
  const Json& near = q["within_tolerance"];
  std::string text;
  if (q.contains("alignment")) {
    const Json& T = q["alignment"]["transform"];
    text = fmt::format("Map laid onto the true one at x {:.2f} m, y {:.2f} m, {:.1f} deg: fit {:.2f}, next best {:.2f}\n",
                       T[0].get<double>(), T[1].get<double>(), T[2].get<double>() * 180.0 / kPi,
                       q["alignment"]["score"].get<double>(), q["alignment"]["rival_score"].get<double>());
  }
  return text + fmt::format("Map quality: IoU {:.3f} of walls, {:.3f} of free space; accuracy {:.3f}; within {:.2f} m: "
                            "precision {:.3f}, recall {:.3f}; walls {:.3f} m off in the mean; {:.1f} % complete\n",
                            q["iou_occupied"].get<double>(), q["iou_free"].get<double>(), q["accuracy"].get<double>(),
                            near["tolerance_m"].get<double>(), near["precision"].get<double>(),
                            near["recall"].get<double>(), q["wall_to_truth_m"]["mean"].get<double>(),
                            100.0 * q["completeness"].get<double>());
}

void write_replay_maps(const slam_glue::SlamResult& slam, const std::filesystem::path& folder) {
  slam_glue::save_ros_map(slam.mapper->states(), folder / "map.yaml");
  slam.mapper->save(folder / "map.gridmap");
  slam_glue::save_octomap(slam.mapper->states(), folder / "map.bt", slam.sensor_z);
}

void print_summary(const slam_glue::SlamResult& slam, const std::string& evaluation, double wall_s,
                   const std::string& method, const Context& ctx) {
  fmt::print("{}", evaluation);
  const double scans = static_cast<double>(slam.scans);
  fmt::print("{}: {} scans, {:.0f} s, {:.1f} m driven, with {} in {:.1f} s ({:.0f} scans/s, {:.0f} x real time){}\n",
             slam.interrupted ? "interrupted" : "mapped", slam.scans, slam.log.duration_s(), slam.path_m, method,
             wall_s, scans / wall_s, slam.log.duration_s() / wall_s,
             ctx.out.empty() ? std::string() : fmt::format("; report: {}", (ctx.out / "report.html").string()));
}

/// Every loop closure, believed or not; times count from the first scan.
Json closures_json(const slam_glue::SlamResult& slam) {
  Json list = Json::array();
  const double t0 = slam.log.first_t;
  for (const auto& c : slam.closures)
    list.push_back({{"t_from", c.t_from - t0}, {"t_to", c.t_to - t0},
                    {"transform", {c.T_from_to.x, c.T_from_to.y, c.T_from_to.theta}},
                    {"residual_m", c.residual_m}, {"residual_deg", c.residual_deg},
                    {"share", c.share}, {"agreement", c.agreement}, {"accepted", c.accepted}, {"why", c.why}});
  return list;
}

Json result_of(const slam_glue::SlamResult& slam, const std::string& method) {
  std::vector<double> metres, degrees;
  for (const auto& c : slam.closures)
    if (c.accepted) metres.push_back(c.residual_m), degrees.push_back(c.residual_deg);
  const std::size_t accepted = metres.size();
  Json slam_json{{"method", method}, {"loop_closures", accepted}, {"refused", slam.closures.size() - accepted},
                 {"keyframes", slam.keyframes}};
  if (accepted > 0) {
    slam_json["closure_residual_m"] = statistics_json(slam_glue::statistics(metres));
    slam_json["closure_residual_deg"] = statistics_json(slam_glue::statistics(degrees));
  }
  slam_json["closures"] = closures_json(slam);
  const auto& c = slam.consistency;
  Json consistency{{"scans", c.scans}, {"end_points_agree", c.end_points_agree}, {"seen_through", c.seen_through},
                   {"doubled_walls", c.doubled_walls}};
  return {{"status", slam.interrupted ? "interrupted" : "mapped"}, {"scans", slam.scans},
          {"duration_s", slam.log.duration_s()}, {"path_m", slam.path_m}, {"slam", std::move(slam_json)},
          {"self_consistency", std::move(consistency)}, {"warnings", slam.warnings}};
}

void replay(Options& o, Context& ctx) {
  check(o);
  if (!ctx.out.empty()) report::check_out_dir(ctx.out, ctx.force);
  if (o.logs.front().extension() == ".lcm") return replay_lcm(o.logs.front(), ctx);
  o.slam.seed = ctx.seed;
  std::optional<OccupancyGrid> truth;
  if (!o.true_map.empty()) truth = open_world(o.true_map.string(), o.slam.resolution).map;
  const auto begin = std::chrono::steady_clock::now();
  slam_glue::SlamResult slam;
  {
    Progress progress("replaying", ctx.quiet);
    slam = slam_glue::run_slam(o.logs.front(), o.slam, [&](const slam_glue::SlamProgress& p) {
      progress.update(p.fraction, fmt::format("{} scans, {:.0f} scans/s", p.scans,
                                              static_cast<double>(p.scans) / std::max(1e-3, progress.elapsed_s())));
      return !ctx.interrupted->load();
    });
  }
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const auto& warning : slam.warnings) fmt::print(stderr, "outrider: warning: {}\n", warning);
  report::RunRecord record = replay_record(o, slam);
  record.version = OUTRIDER_VERSION;
  record.command = ctx.argv;
  record.seed = ctx.seed;
  if (truth) set_truth(std::move(*truth), record);
  record.configuration = {{"log", o.logs.front().string()}, {"slam", o.slam.method},
                          {"resolution_m", o.slam.resolution}, {"max_range_m", o.slam.max_range_m}};
  record.result = result_of(slam, o.slam.method);
  const std::string evaluation = evaluate(o, slam.trajectory, record.result);
  record.timing = {{"wall_s", wall_s}, {"scans_per_s", static_cast<double>(slam.scans) / wall_s},
                   {"realtime_factor", slam.log.duration_s() / wall_s}};
  if (!ctx.out.empty())
    report::write_run_folder(record, ctx.out, {ctx.force}, [&](const auto& dir) { write_replay_maps(slam, dir); });
  const Json document = report::run_json(record);
  if (ctx.json) fmt::print("{}\n", report::to_text(document, 2));
  else if (!ctx.quiet) print_summary(slam, evaluation + quality_lines(document["result"]), wall_s, o.slam.method, ctx);
  ctx.exit_code = slam.interrupted ? kInterrupted : kDone;
}

}  // namespace

void add_replay(CLI::App& app, Context& ctx) {
  auto o = std::make_shared<Options>();
<<<<<<< HEAD:apps/outrider/maps/replay.cpp
  CLI::App* verb = app.add_subcommand(kReplay.name, kReplay.about);
  verb->add_option("LOG", o->logs, "MRPT .rawlog[.gz] or CARMEN .log/.clf[.gz]")->required();
=======
  CLI::App* verb = app.add_subcommand("replay", "a log becomes a map, a trajectory and a report");
  verb->add_option("LOG", o->logs, "MRPT .rawlog[.gz], CARMEN .log/.clf[.gz], or the .lcm recording of a live team")->required();
>>>>>>> 6bed8a1 (Live teams over LCM: auctions that survive bad radio, robot, team, watch, replay of recordings):apps/outrider/replay.cpp
  verb->add_option("--slam", o->slam.method, "see 'outrider list slam'")->capture_default_str()->type_name("METHOD");
  verb->add_option("--resolution", o->slam.resolution, "edge of a cell of the map [m]")
      ->check(number_in(0.005, 10.0))->capture_default_str()->type_name("M");
  verb->add_option("--max-range", o->slam.max_range_m, "echoes from farther away are not used [m]")
      ->check(number_in(0.1, 1000.0))->capture_default_str()->type_name("M");
  verb->add_option("--relations", o->relations, "relations to compare with (Kuemmerle et al. 2009)")->type_name("FILE");
  verb->add_option("--ground-truth", o->ground_truth, "true trajectory: TUM, or lines of t x y theta")
      ->type_name("FILE");
  verb->add_option("--true-map", o->true_map, "true map, for map quality; the map is aligned with it")->type_name("MAP");
  verb->add_option("--start", o->starts, "\"x,y,theta\": pose of the robot at the first scan [m, rad]")->type_name("POSE");
  verb->add_flag("--unknown-starts", o->unknown_starts, "find out how several logs fit together (to come)");
  add_run_flags(*verb, ctx);
  verb->callback([o, &ctx] { replay(*o, ctx); });
}

}  // namespace outrider::app
