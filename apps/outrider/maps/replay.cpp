// `outrider replay`: logs become a map, trajectories and a report.

#include "replay.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "maps_module.hpp"
#include "progress.hpp"
#include "replay_lcm.hpp"
#include "report/metrics.hpp"
#include "report/run_folder.hpp"
#include "slam_glue/map_files.hpp"
#include "true_map.hpp"
#include "verbs.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"
#include "world_source.hpp"

namespace outrider::app {
namespace {

using report::Json;

Pose2 parse_start(const std::string& text) {
  Pose2 start;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%lf,%lf,%lf%c", &start.x, &start.y, &start.theta, &rest) != 3 ||
      !std::isfinite(start.x + start.y + start.theta))
    throw InputError(fmt::format("--start: expected \"x,y,theta\" in m and rad, not '{}'", text));
  return start;
}

void check(ReplayOptions& o) {
  std::vector<std::string> names;
  for (const auto& method : slam_glue::slam_methods()) names.push_back(method.name);
  if (std::find(names.begin(), names.end(), o.slam.method) == names.end())
    throw InputError(fmt::format("--slam: unknown method '{}'{}", o.slam.method, suggestion(o.slam.method, names)));
  for (const std::string& text : o.starts) o.team.starts.push_back(parse_start(text));
  const std::size_t starts = o.starts.size(), logs = o.logs.size();
  if (starts > logs) throw InputError(fmt::format("--start: {} given for {} log{}", starts, logs, logs == 1 ? "" : "s"));
  if (logs == 1) return;
  if (o.team.unknown_starts && starts > 1)
    throw InputError("--unknown-starts: expected at most one --start, that of the first log");
  if (!o.team.unknown_starts && starts < logs)
    throw InputError(fmt::format("replay: {} logs, but {} --start; expected one for every log, or --unknown-starts",
                                 logs, starts));
}

slam_glue::TeamSlamResult run(const ReplayOptions& o, const Context& ctx) {
  Progress progress("replaying", ctx.quiet);
  return slam_glue::run_slam(o.logs, o.slam, o.team, [&](const slam_glue::SlamProgress& p) {
    progress.update(p.fraction, fmt::format("{} scans, {:.0f} scans/s", p.scans,
                                            static_cast<double>(p.scans) / std::max(1e-3, progress.elapsed_s())));
    return !ctx.interrupted->load();
  });
}

Json configuration(const ReplayOptions& o) {
  Json logs = Json::array();
  for (const auto& log : o.logs) logs.push_back(log.string());
  return {{"logs", std::move(logs)}, {"slam", o.slam.method}, {"resolution_m", o.slam.resolution},
          {"max_range_m", o.slam.max_range_m}, {"starts", o.starts}, {"unknown_starts", o.team.unknown_starts}};
}

void print_summary(const Json& result, const Json& timing, const std::string& evaluation, const ReplayOptions& o,
                   const Context& ctx) {
  fmt::print("{}{}{}", evaluation, merge_lines(result), quality_lines(result));
  double driven = 0.0;
  if (result["path_m"].is_object())
    for (const auto& [name, metres] : result["path_m"].items()) driven += metres.get<double>();
  else
    driven = result["path_m"].get<double>();
  const std::string status = result["status"];
  fmt::print("{}: {} scans, {:.0f} s, {:.1f} m driven, with {} in {:.1f} s ({:.0f} scans/s, {:.0f} x real time){}\n",
             status == "not_merged" ? "mapped, but not merged" : status, result["scans"].get<std::size_t>(),
             result["duration_s"].get<double>(), driven, o.slam.method, timing["wall_s"].get<double>(),
             timing["scans_per_s"].get<double>(), timing["realtime_factor"].get<double>(),
             ctx.out.empty() ? std::string() : fmt::format("; report: {}", (ctx.out / "report.html").string()));
}

void replay(ReplayOptions& o, Context& ctx) {
  check(o);
  if (!ctx.out.empty()) report::check_out_dir(ctx.out, ctx.force);
  if (o.logs.front().extension() == ".lcm") return replay_lcm(o.logs.front(), ctx);
  o.slam.seed = ctx.seed;
  std::optional<OccupancyGrid> truth;
  if (!o.true_map.empty()) truth = open_world(o.true_map.string(), o.slam.resolution).map;
  const auto begin = std::chrono::steady_clock::now();
  slam_glue::TeamSlamResult slam = run(o, ctx);
  const double wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  Json result = replay_result(slam, o.slam.method);
  const std::string evaluation = evaluate_trajectories(o, slam, result);
  for (const Json& warning : result["warnings"])
    fmt::print(stderr, "outrider: warning: {}\n", warning.get<std::string>());
  const auto mapper = slam.team.mapper;
  const double sensor_z = slam.logs[0].sensor_z;
  report::RunRecord record = replay_record(o, std::move(slam));
  record.version = OUTRIDER_VERSION;
  record.command = ctx.argv;
  record.seed = ctx.seed;
  if (truth) set_truth(std::move(*truth), record);
  record.configuration = configuration(o);
  record.timing = {{"wall_s", wall_s}, {"scans_per_s", result["scans"].get<double>() / wall_s},
                   {"realtime_factor", result["duration_s"].get<double>() / wall_s}};
  record.result = std::move(result);
  if (!ctx.out.empty())
    report::write_run_folder(record, ctx.out, {ctx.force}, [&](const std::filesystem::path& folder) {
      maps_module().write_maps(record, folder, false);
      mapper->save(folder / "map.gridmap");
      slam_glue::save_octomap(record.map, folder / "map.bt", sensor_z);
    });
  const Json document = report::run_json(record);
  const Json& final = document["result"];
  if (ctx.json) fmt::print("{}\n", report::to_text(document, 2));
  else if (!ctx.quiet) print_summary(final, record.timing, evaluation, o, ctx);
  const std::string status = final["status"];
  ctx.exit_code = status == "interrupted" ? kInterrupted : status == "not_merged" ? kAimMissed : kDone;
}

}  // namespace

void add_replay(CLI::App& app, Context& ctx) {
  auto o = std::make_shared<ReplayOptions>();
  CLI::App* verb = app.add_subcommand(kReplay.name, kReplay.about);
  verb->add_option("LOG", o->logs, "MRPT .rawlog[.gz], CARMEN .log/.clf[.gz], or the .lcm recording of a live team; "
                   "several logs: several robots")->required();
  verb->add_option("--slam", o->slam.method, "see 'outrider list slam'")->capture_default_str()->type_name("METHOD");
  verb->add_option("--resolution", o->slam.resolution, "edge of a cell of the map [m]")
      ->check(number_in(0.005, 10.0))->capture_default_str()->type_name("M");
  verb->add_option("--max-range", o->slam.max_range_m, "echoes from farther away are not used [m]")
      ->check(number_in(0.1, 1000.0))->capture_default_str()->type_name("M");
  verb->add_option("--relations", o->relations, "relations to compare with (Kuemmerle et al. 2009)")->type_name("FILE");
  verb->add_option("--ground-truth", o->ground_truth, "true trajectory: TUM, or lines of t x y theta")
      ->type_name("FILE");
  verb->add_option("--true-map", o->true_map, "true map, for map quality; the map is aligned with it")->type_name("MAP");
  verb->add_option("--start", o->starts, "\"x,y,theta\": pose of a robot at its first scan [m, rad]; once a log")
      ->type_name("POSE");
  verb->add_flag("--unknown-starts", o->team.unknown_starts,
                 "find out how several logs fit together; what is not sure is refused");
  add_run_flags(*verb, ctx);
  verb->callback([o, &ctx] { replay(*o, ctx); });
}

}  // namespace outrider::app
