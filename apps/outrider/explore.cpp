// `outrider explore`: a simulated team explores a world that it does not know.

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <sstream>

#include "auction/bid_options.hpp"
#include "comms_spec.hpp"
#include "context.hpp"
#include "explore.hpp"
#include "explorer/mission.hpp"
#include "maps_module.hpp"
#include "mission_record.hpp"
#include "progress.hpp"
#include "report/metrics.hpp"
#include "report/run_folder.hpp"
#include "specs.hpp"
#include "team_file.hpp"
#include "true_map.hpp"
#include "world/error.hpp"
#include "world_source.hpp"

namespace outrider::app {

using explorer::MissionResult;
using explorer::MissionSettings;
using report::Json;

MissionSettings mission_settings(const ExploreOptions& o, std::uint64_t seed, const std::vector<RobotSpec>& team) {
  MissionSettings settings;
  settings.coordinator = o.coordinator;
  explorer::make_coordinator(o.coordinator, {});  // an unknown name stops here, before any work
  settings.coordination.bids = o.bids;
  settings.coordination.cluster_spacing =
      std::min_element(team.begin(), team.end(), [](const auto& a, const auto& b) { return a.range < b.range; })->range;
  settings.explorer.return_home = o.return_home;
  settings.localization = o.localization == "slam"       ? explorer::Localization::kSlam
                          : o.localization == "odometry" ? explorer::Localization::kOdometry
                                                         : explorer::Localization::kPerfect;
  auto& noise = settings.odometry;
  noise.shift_per_sqrt_m *= o.odometry_noise;
  noise.turn_per_sqrt_m *= o.odometry_noise;
  noise.turn_per_sqrt_rad *= o.odometry_noise;
  settings.sim.lidar = o.sensing == "lidar" || settings.localization != explorer::Localization::kPerfect;
  if (settings.sim.lidar) settings.make_mapper = std::bind_front(&MapsModule::make_scan_mapper, &maps_module());
  if (settings.localization == explorer::Localization::kSlam)
    settings.make_tracking = std::bind_front(&MapsModule::make_pose_tracking, &maps_module());
  settings.sim.range_noise = o.range_noise;
  settings.sim.seed = seed;
  settings.until = o.until;
  settings.max_time_s = o.max_time;
  settings.faults = parse_faults(o.fault, team);
  settings.radio = parse_comms(o.comms, team);
  settings.radio.seed = seed;
  return settings;
}

namespace {

Json configuration(const ExploreOptions& o, const MissionSettings& s) {
  return {{"world", o.world}, {"coordinator", o.coordinator}, {"comms", o.comms},
          {"sensing", s.sim.lidar ? "lidar" : "disc"}, {"localization", o.localization},
          {"odometry_noise", o.odometry_noise}, {"starts", o.starts}, {"until", o.until}, {"max_time_s", o.max_time},
          {"return_home", o.return_home}, {"fault", o.fault}, {"step_s", s.sim.dt}, {"range_noise_m", o.range_noise},
          {"scan_rate_hz", s.sim.scan_rate}, {"bids", auction::bid_options_text(o.bids)}};
}

Json timing(double wall_s, MissionResult& result) {
  auto& ms = result.decision_ms;
  std::sort(ms.begin(), ms.end());
  const auto quantile = [&](double q) {
    return ms.empty() ? 0.0 : ms[static_cast<std::size_t>(q * static_cast<double>(ms.size() - 1))];
  };
  return {{"wall_s", wall_s},
          {"decision_ms", {{"p50", quantile(0.5)}, {"p95", quantile(0.95)}, {"max", quantile(1.0)}}},
          {"realtime_factor", wall_s > 0.0 ? result.mission_time_s / wall_s : 0.0}};
}

}  // namespace

Json world_json(const sim::World& world) {
  const auto& g = world.map.geometry();
  return {{"name", world.name}, {"width_m", g.width * g.resolution}, {"height_m", g.height * g.resolution},
          {"resolution_m", g.resolution}, {"provenance", world.provenance}};
}

int exit_code(const Json& result) {
  const std::string status = result["status"];
  return status == "explored" ? kDone : status == "interrupted" ? kInterrupted : kAimMissed;
}

void print_summary(const report::RunRecord& record, const Json& result, const Context& ctx) {
  const std::string status = result["status"];
  fmt::print("{}: {:.1f} % of {:.1f} m² in {:.1f} s with {} robot{}, {}; {:.1f} m driven, {} messages", status,
             100.0 * result["explored_fraction"].get<double>(), result["reachable_m2"].get<double>(),
             result["time_s"].get<double>(), record.robots.size(), record.robots.size() == 1 ? "" : "s",
             record.coordinator, [&] {
               double sum = 0.0;
               for (const auto& [name, metres] : result["path_m"].items()) sum += metres.get<double>();
               return sum;
             }(), result["messages"]["sent"].get<std::uint64_t>());
  fmt::print("{}\n", ctx.out.empty() ? std::string() : fmt::format("; report: {}", (ctx.out / "report.html").string()));
}

namespace {

report::RunRecord run_shown(const ExploreOptions& o, const Context& ctx) {
  Progress progress("exploring", ctx.quiet);
  return run_exploration(o, open_exploration_world(o), ctx.seed, true, [&](double now_s, double done) {
    progress.update(done, fmt::format("{:.0f} s simulated", now_s));
    return !ctx.interrupted->load();
  });
}

void explore(const ExploreOptions& o, Context& ctx) {
  if (!ctx.out.empty()) report::check_out_dir(ctx.out, ctx.force);
  report::RunRecord record = run_shown(o, ctx);
  record.command = ctx.argv;
  if (!ctx.out.empty())
    report::write_run_folder(record, ctx.out, {ctx.force},
                             [&](const auto& folder) { maps_module().write_maps(record, folder, o.octomap); });
  const Json document = report::run_json(record);
  if (ctx.json) fmt::print("{}\n", document.dump(2));
  else if (!ctx.quiet) print_summary(record, document["result"], ctx);
  ctx.exit_code = exit_code(document["result"]);
}

}  // namespace

std::vector<RobotSpec> team_of(const ExploreOptions& o, const sim::World& world, std::uint64_t seed) {
  TeamFile team = o.team_file.empty() ? usual_team(world, o.robots) : read_team_file(o.team_file);
  if (o.starts == "world") return place_team(world, std::move(team));
  std::vector<double> radii;
  for (const RobotSpec& robot : team.robots) radii.push_back(robot.radius);
  sim::World drawn = world;
  drawn.starts = sim::random_starts(world, radii, seed);
  return place_team(drawn, std::move(team));
}

void check_exploration(const ExploreOptions& o, const sim::World& world) {
  constexpr std::uint64_t kAnySeed = 1;
  mission_settings(o, kAnySeed, team_of(o, world, kAnySeed));
}

sim::World open_exploration_world(const ExploreOptions& o) {
  sim::World world = open_world(o.world, o.resolution);
  world.map = explorer::solid_map(std::move(world.map));
  return world;
}

report::RunRecord run_exploration(const ExploreOptions& o, const sim::World& world, std::uint64_t seed,
                                  bool record_events, const explorer::MissionProgress& progress) {
  const std::vector<RobotSpec> team = team_of(o, world, seed);
  MissionSettings settings = mission_settings(o, seed, team);
  settings.record_events = record_events;
  const auto begin = std::chrono::steady_clock::now();
  MissionResult result;
  try {
    result = explorer::run_mission(world.map, team, settings, progress);
  } catch (const InputError& e) {  // an impossible start: say whose
    if (o.team_file.empty()) throw;
    throw InputError(fmt::format("{}: {}", o.team_file.string(), e.what()));
  }
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  Json times = timing(wall.count(), result);
  report::RunRecord record = mission_record(std::move(result), settings, world.map);
  if (settings.localization != explorer::Localization::kPerfect) maps_module().set_truth(world.map, record);
  record.version = OUTRIDER_VERSION;
  record.seed = seed;
  record.world = world_json(world);
  record.comms = o.comms;
  record.configuration = configuration(o, settings);
  record.timing = std::move(times);
  return record;
}

void add_team_options(CLI::App& verb, ExploreOptions& o) {
  verb.add_option("WORLD", o.world, "name from 'outrider list worlds', or a map: ROS .yaml, image, .gridmap[.gz], "
                   "MovingAI .map, ASCII .txt")->capture_default_str();
  verb.add_option("--resolution", o.resolution, "edge of a cell for images, .map and .txt [m]")
      ->check(number_in(1e-3, 1e3))->type_name("M");
  auto* robots = verb.add_option("--robots", o.robots, "size of the team (default: the world's usual team)")
                     ->check(CLI::Range(1, 1000))->type_name("N");
  verb.add_option("--team", o.team_file, "team file (YAML)")->type_name("FILE")->excludes(robots);
  verb.add_option("--starts", o.starts, "where robots begin that the team file gives no start: the world's places, or "
                   "places drawn from the seed")
      ->check(CLI::IsMember({"world", "random"}))->capture_default_str()->type_name("KIND");
  verb.add_option("--coordinator", o.coordinator, "who goes where; see 'outrider list coordinators'")
      ->capture_default_str()->type_name("NAME");
  verb.add_option("--comms", o.comms, "radio: ideal, none, range:R, los, loss:P, delay:S, breaks:NxS[@WITHIN], "
                   "break:T0-T1[:A+B], split:T0-T1:A+B; comma-separated")->capture_default_str()->type_name("SPEC");
  verb.add_option("--sensing", o.sensing, "disc: every cell in range and sight; lidar: simulated scans")
      ->check(CLI::IsMember({"disc", "lidar"}))->capture_default_str()->type_name("KIND");
  verb.add_option("--range-noise", o.range_noise, "standard deviation of a lidar range [m]")
      ->check(number_in(0.0, 10.0))->capture_default_str()->type_name("M");
  verb.add_option("--max-time", o.max_time, "stop after this much simulated time [s] (default: a generous limit)")
      ->check(number_in(1e-3, 1e9))->type_name("S");
  verb.add_flag("--return-home", o.return_home, "drive back to the starts in the end");
  verb.add_flag("--octomap", o.octomap, "also write map.bt (OctoMap)");
  verb.add_option_function<std::vector<std::string>>("--bids", [&o](const auto& items) {
        for (const std::string& item : items) auction::set_bid_options(o.bids, item);
      }, "parameters and readings of ia, ea, daa, ta: rho=X, gamma=X, ...; comma-separated; all keys below")
      ->delimiter(',')->type_name("KEY=VALUE");
}

void add_explore_options(CLI::App& verb, ExploreOptions& o) {
  add_team_options(verb, o);
  verb.add_option("--localization", o.localization, "perfect; odometry: wheels that slip; slam: scan matching "
                   "against the own map corrects them. The last two sense with a lidar")
      ->check(CLI::IsMember({"perfect", "odometry", "slam"}))->capture_default_str()->type_name("KIND");
  verb.add_option("--odometry-noise", o.odometry_noise, "how much the wheels slip, times the usual "
                   "0.03 m, 0.02 rad after 1 m and 0.03 rad after 1 rad")
      ->check(number_in(0.0, 100.0))->capture_default_str()->type_name("FACTOR");
  verb.add_option("--until", o.until, "stop when this fraction of the reachable area has been seen")
      ->check(number_in(0.01, 1.0))->capture_default_str()->type_name("FRACTION");
  verb.add_option("--fault", o.fault, "kill:ROBOT@T, revive:ROBOT@T, slow:ROBOT@T:FACTOR, deaf:ROBOT@T0-T1; "
                   "comma-separated")
      ->type_name("SPEC");
}

void add_explore(CLI::App& app, Context& ctx) {
  auto o = std::make_shared<ExploreOptions>();
  CLI::App* verb = app.add_subcommand("explore", "a simulated team explores an unknown world");
  add_explore_options(*verb, *o);
  std::string keys = "Keys of --bids:\n";
  for (const auto& option : auction::bid_options())
    keys += fmt::format("  {:<7} {}: {}\n", option.key, option.values, option.about);
  verb->footer(keys);
  add_run_flags(*verb, ctx);
  verb->callback([o, &ctx] { explore(*o, ctx); });
}

}  // namespace outrider::app
