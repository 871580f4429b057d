// `outrider allocate`: multi-task missions on topological maps (docs/missions.md).

#include "allocate.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <chrono>

#include "comms_spec.hpp"
#include "decision/grid_topology.hpp"
#include "explorer/mission.hpp"
#include "explorer/mission_draw.hpp"
#include "explorer/mission_file.hpp"
#include "progress.hpp"
#include "report/run_folder.hpp"
#include "world/error.hpp"
#include "world_source.hpp"

namespace outrider::app {
namespace {

using explorer::AllocationResult;
using explorer::AllocationSettings;

const std::map<std::string, explorer::Protocol> kProtocols{{"continuous", explorer::Protocol::kContinuous},
                                                           {"ssa", explorer::Protocol::kSsa},
                                                           {"dssa", explorer::Protocol::kDssa},
                                                           {"optimal", explorer::Protocol::kOptimal},
                                                           {"scout", explorer::Protocol::kScout}};
const std::map<std::string, explorer::Initial> kInitials{{"empty", explorer::Initial::kEmpty},
                                                         {"random", explorer::Initial::kRandom},
                                                         {"current", explorer::Initial::kCurrent},
                                                         {"nearest", explorer::Initial::kNearest}};

template <class T>
std::vector<std::string> names(const std::map<std::string, T>& table) {
  std::vector<std::string> list;
  for (const auto& [name, value] : table) list.push_back(name);
  return list;
}

AllocationSettings settings_of(const AllocateOptions& o, std::uint64_t seed) {
  AllocationSettings s;
  s.protocol = kProtocols.at(o.protocol);
  s.initial = kInitials.at(o.initial);
  s.gains = o.gains == "sum" ? explorer::Gains::kSum : explorer::Gains::kMakespan;
  s.noc = o.noc;
  s.return_home = o.return_home;
  s.starts = o.starts;
  s.seed = seed;
  const link::RadioSpec radio = parse_comms(o.comms, {});
  if (radio.none || radio.range_m || radio.line_of_sight || !radio.breaks.empty() || !radio.random_breaks.empty())
    throw InputError(fmt::format("--comms {}: expected ideal, loss:P, delay:S or both; who negotiates stays in touch", o.comms));
  s.radio.loss = radio.loss;
  if (radio.delay_s > 0.0) s.radio.delay_s = radio.delay_s;
  if (s.radio.loss >= 0.9) throw InputError(fmt::format("--comms {}: expected a loss below 0.9", o.comms));
  s.radio.times.repeat_s = std::max(s.radio.times.repeat_s, 2.0 * s.radio.delay_s);
  s.radio.times.dead_s = std::max(s.radio.times.dead_s, 24.0 * s.radio.times.repeat_s);
  if (s.radio.loss > 0.3) s.radio.times.dead_s *= 4.0;  // a living robot must never seem dead
  s.radio.most_s = std::max(s.radio.most_s, 40.0 * s.radio.times.dead_s);
  return s;
}

explorer::ExecutionResult execute(const AllocateMission& m, const AllocateOptions& o, const Context& ctx) {
  explorer::ExecutionSettings s;
  s.robot = m.robot;
  s.allocation = settings_of(o, ctx.seed);
  s.seed = ctx.seed;
  s.rendezvous_m = o.rendezvous_m;
  s.pilot.reach.radius = m.robot.radius;
  s.pilot.interpret.passage = 2.0 * m.robot.radius + 0.2;
  Progress progress("driving", ctx.quiet);
  return explorer::execute(*m.grid, m.mission, s, [&](double now_s) {
    progress.update(0.0, fmt::format("{:.0f} s simulated", now_s));
    return !ctx.interrupted->load();
  });
}

void write_folder(const AllocateMission& m, const AllocateOptions& o, const AllocationResult& result,
                  const explorer::ExecutionResult* run, const report::Json& document, const Context& ctx) {
  std::filesystem::create_directories(ctx.out);
  report::write_file(ctx.out / "mission.yaml", explorer::mission_text(m.mission));
  std::string csv = "robot,order,goal,x_m,y_m\n";
  for (std::size_t i = 0; i < m.mission.robots.size(); ++i)
    for (std::size_t k = 0; k < result.order[i].size(); ++k) {
      const auto& w = m.mission.map.waypoints[static_cast<std::size_t>(m.mission.goals[static_cast<std::size_t>(result.order[i][k])])];
      csv += fmt::format("{},{},{},{:.3f},{:.3f}\n", m.mission.robots[i].name, k + 1, report::csv_field(w.id), w.pose.x, w.pose.y);
    }
  report::write_file(ctx.out / "allocation.csv", csv);
  if (run != nullptr) write_execution(m, *run, ctx.out);
  report::write_file(ctx.out / "report.html", allocate_page(m, o, result, run));
  report::write_file(ctx.out / "run.json", report::to_text(document, 2) + '\n');
}

void allocate(const AllocateOptions& o, Context& ctx) {
  if (!ctx.out.empty()) report::check_out_dir(ctx.out, ctx.force);
  const AllocateMission m = open_mission(o, ctx.seed);
  const auto begin = std::chrono::steady_clock::now();
  explorer::TeamCosts costs(m.mission, o.return_home);
  const AllocationResult result = explorer::allocate(m.mission, costs, settings_of(o, ctx.seed));
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  report::Json document = allocate_json(m, o, result, ctx);
  std::optional<explorer::ExecutionResult> run;
  if (o.execute) {
    run = execute(m, o, ctx);
    document["result"]["execution"] = execution_json(m, *run);
  }
  document["timing"] = {{"wall_s", wall.count()}};
  if (!ctx.out.empty()) write_folder(m, o, result, run ? &*run : nullptr, document, ctx);
  if (ctx.json) {
    fmt::print("{}\n", report::to_text(document, 2));
  } else if (!ctx.quiet) {
    for (std::size_t i = 0; i < m.mission.robots.size(); ++i) {
      fmt::print("{}:", m.mission.robots[i].name);
      for (const auto& id : document["result"]["allocation"][m.mission.robots[i].name]) fmt::print(" {}", id.get<std::string>());
      fmt::print(" ({:.1f} s)\n", result.mission_s[i]);
    }
    fmt::print("{}{}\n", allocate_verdict(m, o, result),
               ctx.out.empty() ? std::string() : fmt::format("; report: {}", (ctx.out / "report.html").string()));
  }
  if (run && !ctx.json && !ctx.quiet) fmt::print("{}\n", execution_verdict(m, *run));
  const bool reached = !run || run->missed.empty();
  ctx.exit_code = run && run->interrupted ? kInterrupted : result.agreed && result.undone.empty() && reached ? kDone : kAimMissed;
}

}  // namespace

AllocateMission open_mission(const AllocateOptions& o, std::uint64_t seed) {
  if (o.mission.empty() && o.map.empty()) throw InputError("allocate: expected a MISSION file, or --map WORLD to draw one");
  if (!o.mission.empty() && !o.map.empty() && !o.execute)
    throw InputError("allocate: MISSION and --map together only with --execute: the world that the mission is driven in");
  if (o.map.empty() && o.execute) throw InputError("allocate: --execute needs --map WORLD, the world to drive in");
  AllocateMission m;
  if (!o.map.empty()) {
    sim::World world = open_world(o.map, o.resolution);
    m.robot = world.team.empty() ? RobotSpec{} : world.team[0];
    if (o.radius > 0.0) m.robot.radius = o.radius;
    m.robot.fov = 2.0 * kPi;
    m.grid = explorer::solid_map(std::move(world.map));
    m.name = world.name;
  }
  if (!o.mission.empty()) {
    m.mission = explorer::read_mission(o.mission);
    m.name = o.mission.stem().string();
  } else {
    m.mission = explorer::draw_mission(decision::topology_of(*m.grid, {.radius = m.robot.radius}), o.goals, o.robots,
                                       o.together ? explorer::Starts::kTogether : explorer::Starts::kApart, seed);
  }
  return m;
}

void add_allocate(CLI::App& app, Context& ctx) {
  auto o = std::make_shared<AllocateOptions>();
  CLI::App* verb = app.add_subcommand("allocate", "multi-task missions on topological maps");
  verb->add_option("MISSION", o->mission, "mission file (YAML): waypoints, paths, robots, goals")->type_name("FILE");
  verb->add_option("--map", o->map, "draw a mission on the topological map of this world or map file")->type_name("WORLD");
  verb->add_option("--resolution", o->resolution, "edge of a cell for images, .map and .txt [m]")
      ->check(number_in(1e-3, 1e3))->type_name("M");
  verb->add_option("--goals", o->goals, "with --map: number of goals")->check(CLI::Range(0, 256))->capture_default_str();
  verb->add_option("--robots", o->robots, "with --map: number of robots")->check(CLI::Range(1, 1000))->capture_default_str();
  verb->add_flag("--together", o->together, "with --map: all robots start at one waypoint");
  verb->add_option("--radius", o->radius, "of the robots [m] (default: of the world's usual team)")
      ->check(number_in(1e-3, 100.0))->type_name("M");
  verb->add_option("--protocol", o->protocol, "continuous, ssa, dssa (Lozenguez 2015), optimal (enumeration), scout (makespan)")
      ->check(CLI::IsMember(names(kProtocols)))->capture_default_str();
  verb->add_option("--noc", o->noc, "opportunity cost, of the largest cost between two waypoints (eq. 11)")
      ->check(number_in(0.0, 1e6))->capture_default_str();
  verb->add_option("--initial", o->initial, "allocation to begin with: empty, random, current (of the mission file), nearest")
      ->check(CLI::IsMember(names(kInitials)))->capture_default_str();
  verb->add_option("--gains", o->gains, "ssa, dssa, optimal: sum (eq. 10) or makespan (a power mean of the missions' durations)")
      ->check(CLI::IsMember({"sum", "makespan"}))->capture_default_str();
  verb->add_option("--starts", o->starts, "scout: beginnings of the search, shared out among the robots")
      ->check(CLI::Range(1, 100000))->capture_default_str();
  verb->add_flag("--return-home", o->return_home, "missions end where they began");
  verb->add_option("--comms", o->comms, "radio of dssa and scout: ideal, loss:P, delay:S; comma-separated")->capture_default_str();
  verb->add_flag("--execute", o->execute, "drive the mission in the lidar simulator, with drifting odometers");
  verb->add_option("--rendezvous", o->rendezvous_m, "--execute: robots nearer than this re-open the auction [m]; 0: never")
      ->check(number_in(0.0, 1e6))->capture_default_str()->type_name("M");
  add_run_flags(*verb, ctx);
  verb->callback([o, &ctx] { allocate(*o, ctx); });
}

}  // namespace outrider::app
