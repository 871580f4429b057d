// `outrider robot`: one live robot.

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cmath>
#include <cstdio>

#include "live.hpp"
#include "maps_module.hpp"
#include "mission_record.hpp"
#include "report/run_folder.hpp"
#include "sim/arena.hpp"
#include "specs.hpp"
#include "world/error.hpp"

namespace outrider::app {
namespace {

struct Options {
  LiveOptions live;
  std::string name, body = "simulated", area;
  std::filesystem::path arena;
};

/// The ground on which a real team agrees to explore: nobody knows what is there.
sim::World agreed_area(const Options& o) {
  Point low, high;
  char rest = 0;
  if (std::sscanf(o.area.c_str(), "%lf,%lf,%lf,%lf%c", &low.x, &low.y, &high.x, &high.y, &rest) != 4 || !(low.x < high.x) || !(low.y < high.y))
    throw InputError(fmt::format("--area: expected \"x0,y0,x1,y1\" in m, lower left and upper right corner, not '{}'", o.area));
  const double resolution = o.live.mission.resolution.value_or(0.1);
  const auto cells = [&](double metres) { return static_cast<int>(std::ceil(metres / resolution)); };
  sim::World world;
  world.name = "area";
  world.map = OccupancyGrid({resolution, low, cells(high.x - low.x), cells(high.y - low.y)}, CellState::kFree);
  return world;
}

/// What team-mates told this robot counts as explored, from the end of its run on.
void add_what_was_heard(explorer::RobotJournal& journal) {
  if (!journal.farewell || journal.entries.empty()) return;
  explorer::RobotJournal::Entry heard{journal.entries.back().t, journal.entries.back().pose, {}};
  for (std::uint32_t i = 0; i < journal.farewell->map.size(); ++i)
    if (journal.farewell->map[i] != CellState::kUnknown) heard.cells.push_back(i);
  journal.entries.push_back(std::move(heard));
}

void robot(Options o, Context& ctx) {
  o.live.real_body = o.body == "lcm";
  if (!ctx.out.empty()) report::check_out_dir(ctx.out, ctx.force);
  const sim::World world = o.live.real_body ? agreed_area(o) : open_exploration_world(o.live.mission);
  const std::vector<RobotSpec> team = team_of(o.live.mission, world, ctx.seed);
  const RobotId self = o.name.empty() ? 0 : robot_called(o.name, "--name", team);
  std::vector<explorer::RobotJournal> journals(team.size());
  explorer::RobotJournal& journal = journals[static_cast<std::size_t>(self)];
  if (!o.arena.empty()) {
    std::vector<Pose2> starts;
    for (const RobotSpec& member : team) starts.push_back(member.start);
    sim::Arena::create_if_absent(o.arena, starts);
  }
  const double begin_s = monotonic_s();
  run_robot(o.live, world, team, self, o.arena, ctx.seed, *ctx.interrupted,
            [&](const std::string& line) { explorer::read_line(line, world.map.geometry(), journal); });
  add_what_was_heard(journal);
  report::RunRecord record = live_record(o.live, world, team, ctx.seed, journals, monotonic_s() - begin_s);
  record.verb = "robot";
  if (o.live.real_body) record.truth.reset();
  const std::string& name = team[static_cast<std::size_t>(self)].name;
  record.result["link"] = {{name, record.result["link"][name]}};  // of the others nothing is known
  record.command = ctx.argv;
  if (!ctx.out.empty())
    report::write_run_folder(record, ctx.out, {ctx.force}, [&](const auto& folder) {
      maps_module().write_maps(record, folder, o.live.mission.octomap);
    });
  const report::Json document = report::run_json(record);
  if (ctx.json) fmt::print("{}\n", document.dump(2));
  else if (!ctx.quiet) print_summary(record, document["result"], ctx);
  ctx.exit_code = exit_code(document["result"]);
}

}  // namespace

void add_robot(CLI::App& app, Context& ctx) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("robot", "one live robot of a team, over LCM");
  add_live_options(*verb, o->live);
  verb->add_option("--name", o->name, "which robot of the team (default: the first)")->type_name("NAME");
  verb->add_option("--arena", o->arena, "file where simulated bodies on this machine meet; made by the first robot")
      ->type_name("FILE");
  verb->add_option("--body", o->body, "simulated, or lcm: scans (bot_core.planar_lidar_t) and poses (bot_core.pose_t) come from "
                   "drivers, paths and velocities go to them")
      ->check(CLI::IsMember({"simulated", "lcm"}))->capture_default_str()->type_name("KIND");
  verb->add_option("--area", o->area, "lcm body: the ground to explore, \"x0,y0,x1,y1\" [m]; all robots name the same")->type_name("BOX");
  verb->add_option("--laser", o->live.body.laser, "lcm body: channel of the scans")->capture_default_str()->type_name("CHANNEL");
  verb->add_option("--pose", o->live.body.pose, "lcm body: channel of the poses")->capture_default_str()->type_name("CHANNEL");
  verb->add_option("--path", o->live.body.path, "lcm body: channel of the paths")->capture_default_str()->type_name("CHANNEL");
  verb->add_option("--velocity", o->live.body.velocity, "lcm body: channel of the velocities")->capture_default_str()->type_name("CHANNEL");
  add_run_flags(*verb, ctx);
  verb->callback([o, &ctx] { robot(*o, ctx); });
}

}  // namespace outrider::app
