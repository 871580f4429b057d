#include "live.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

#include "comms_spec.hpp"
#include "explorer/live_robot.hpp"
#include "explorer/referee.hpp"
#include "link/impaired_bus.hpp"
#include "link/lcm_bus.hpp"
#include "maps_module.hpp"
#include "mission_record.hpp"
#include "sim/arena.hpp"
#include "world/error.hpp"

namespace outrider::app {
namespace {

using report::Json;

constexpr double kMostMessages = 2000.0;  // of one sender, a second of the run

std::int64_t boot_number() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

/// The body of one robot: real, in the arena where the team meets, or alone in the world.
struct RobotBody {
  RobotBody(const LiveOptions& o, const OccupancyGrid& truth, const std::vector<RobotSpec>& team, RobotId self,
            const sim::SimOptions& options, const std::filesystem::path& arena) {
    const RobotSpec& spec = team[static_cast<std::size_t>(self)];
    if (o.real_body) {
      link::LcmBodySettings settings = o.body;
      settings.speed = spec.speed;
      settings.range_max = spec.range;
      settings.arrive_m = spec.radius;
      real.emplace(link::MulticastUrl::parse(o.url), std::move(settings));
    } else if (arena.empty()) {
      alone.emplace(truth, std::vector{spec}, options);
    } else {
      shared.emplace(truth, team, self, options, arena);
    }
  }
  explorer::LiveBody body() {
    if (real) return {&*real, [] {}, [this] { return real->path_m(); }};
    if (alone) return {&alone->body(0), [this] { alone->step(); }, [this] { return alone->path_m(0); }};
    return {&shared->body(), [this] { shared->step(); }, [this] { return shared->path_m(); }};
  }
  std::optional<link::LcmBody> real;
  std::optional<sim::Simulator> alone;
  std::optional<sim::ArenaSimulator> shared;
};

/// A real robot begins where its driver says it is.
void wait_for_pose(link::LcmBody& body, const std::atomic<bool>& interrupted) {
  while (!interrupted && !body.has_pose()) {
    body.sense();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

explorer::LiveSettings live_settings(const LiveOptions& o, const explorer::MissionSettings& mission, const sim::World& world,
                                     const std::vector<RobotSpec>& team, RobotId self) {
  explorer::LiveSettings live;
  live.self = self;
  live.team = team;
  live.geometry = world.map.geometry();
  live.coordinator = mission.coordinator;
  live.coordination = mission.coordination;
  live.explorer = mission.explorer;
  if (mission.sim.lidar || o.real_body)
    live.make_mapper = std::bind_front(&MapsModule::make_scan_mapper, &maps_module());
  live.period_s = mission.sim.dt;
  live.most_s = mission.max_time_s;
  live.silent_is_gone_s = o.gone_s;
  live.time_scale = o.speed;
  return live;
}

link::GuardSettings guard_settings(const LiveOptions& o, const sim::World& world, const std::vector<RobotSpec>& team, RobotId self) {
  link::GuardSettings guard{.self = self, .robots = static_cast<int>(team.size()), .run = o.run, .boot = boot_number()};
  guard.geometry = world.map.geometry();
  if (!o.key_file.empty()) guard.key = link::TeamKey::read(o.key_file);
  guard.most_per_s = kMostMessages * std::max(1.0, o.speed);
  return guard;
}

/// The radio of --comms as one robot hears it: all robots agree on the breaks, losses are each robot's own.
link::RadioSpec own_radio(link::RadioSpec spec, RobotId self, double horizon_s) {
  if (spec.range_m || spec.line_of_sight)
    throw InputError("--comms: range and los need the simulator ('explore'); a live radio takes loss, delay, breaks and splits");
  spec.breaks = link::schedule(spec, horizon_s);
  spec.random_breaks.clear();
  spec.seed += 1000003U * static_cast<std::uint64_t>(self + 1);
  return spec;
}

Json link_json(const explorer::LiveFarewell& f) {
  Json rejected = Json::object();
  for (std::size_t k = 0; k < link::kRejections; ++k)
    if (f.rejections.count[k] > 0) rejected[std::string(link::kRejectionNames[k])] = f.rejections.count[k];
  return {{"sent", f.bus.sent}, {"bytes", f.bus.bytes}, {"unsent", f.bus.unsent}, {"delivered", f.bus.delivered},
          {"reopened", f.bus.reopened}, {"rejected", rejected}, {"left_s", f.t}, {"maps_differed_until_s", f.equal_s},
          {"map_hash", fmt::format("{:016x}", f.map_hash)}};
}

}  // namespace

double monotonic_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

explorer::LiveEnd run_robot(const LiveOptions& o, const sim::World& world, const std::vector<RobotSpec>& team, RobotId self,
                            const std::filesystem::path& arena, std::uint64_t seed, const std::atomic<bool>& interrupted,
                            const explorer::LineSink& journal) {
  const explorer::MissionSettings mission = mission_settings(o.mission, seed, team);
  RobotBody robot(o, world.map, team, self, mission.sim, arena);
  if (robot.real) wait_for_pose(*robot.real, interrupted);
  const double begin_s = robot.shared ? robot.shared->begin_s() : monotonic_s();
  const auto now_s = [&] { return (monotonic_s() - begin_s) * o.speed; };
  link::LcmBus air(link::MulticastUrl::parse(o.url), guard_settings(o, world, team, self), monotonic_s);
  const double horizon_s = explorer::Referee(world.map, team).expected_s();
  link::Radio radio(own_radio(mission.radio, self, horizon_s), horizon_s, world.map, [](RobotId) { return Point{}; });
  link::ImpairedBus impaired(air, self, [&](RobotId from, RobotId to, double t) { return radio(from, to, t); }, now_s);
  link::Bus& bus = o.mission.comms == "ideal" ? static_cast<link::Bus&>(air) : impaired;
  std::vector<report::RobotRecord> names(team.size());
  for (std::size_t r = 0; r < team.size(); ++r) names[r].spec = team[r];
  const auto on_event = [&](double t, const explorer::Event& event) {
    journal(explorer::event_line(report::to_text(event_json(t, event, world.map.geometry(), names))));
  };
  const explorer::LiveClock clock{now_s, [&](double until_s) { return air.wait(begin_s + until_s / o.speed); }};
  explorer::LiveFarewell farewell =
      explorer::run_live(live_settings(o, mission, world, team, self), robot.body(), bus, clock, interrupted, journal, on_event);
  farewell.bus = air.counters();
  farewell.rejections = air.rejections();
  explorer::write_farewell(farewell, journal);
  return farewell.end;
}

report::RunRecord live_record(const LiveOptions& o, const sim::World& world, const std::vector<RobotSpec>& team,
                              std::uint64_t seed, std::vector<explorer::RobotJournal>& journals, double wall_s) {
  const explorer::MissionSettings mission = mission_settings(o.mission, seed, team);
  report::RunRecord record = mission_record(explorer::gather(world.map, team, journals), mission, world.map);
  Json robots = Json::object();
  for (std::size_t r = 0; r < team.size(); ++r) {
    for (const std::string& line : journals[r].events)
      if (Json event = Json::parse(line, nullptr, false); !event.is_discarded()) record.events.push_back(std::move(event));
    robots[team[r].name] = journals[r].farewell ? link_json(*journals[r].farewell) : Json("killed");
  }
  std::stable_sort(record.events.begin(), record.events.end(),
                   [](const Json& a, const Json& b) { return a.value("t", 0.0) < b.value("t", 0.0); });
  record.result["link"] = std::move(robots);
  record.version = OUTRIDER_VERSION;
  record.seed = seed;
  record.world = world_json(world);
  record.comms = o.mission.comms;
  record.configuration = {{"world", o.real_body ? world.name : o.mission.world}, {"coordinator", o.mission.coordinator}, {"comms", o.mission.comms},
                          {"sensing", o.mission.sensing}, {"url", o.url}, {"speed", o.speed}, {"key", !o.key_file.empty()},
                          {"max_time_s", o.mission.max_time}, {"gone_s", o.gone_s}, {"return_home", o.mission.return_home}};
  const double simulated_s = record.result.value("mission_time_s", 0.0);
  record.timing = {{"wall_s", wall_s}, {"realtime_factor", wall_s > 0.0 ? simulated_s / wall_s : 0.0}};
  return record;
}

void add_live_options(CLI::App& verb, LiveOptions& o) {
  add_team_options(verb, o.mission);
  verb.add_option("--url", o.url, "multicast group, as LCM writes it; ttl=0 stays on this machine, ttl=1 on its network")
      ->capture_default_str()->type_name("URL");
  verb.add_option("--key", o.key_file, "file with the team's secret: every message is signed, others are noise")
      ->type_name("FILE");
  verb.add_option("--run", o.run, "number of the team: teams on one network do not hear each other")
      ->check(CLI::Range(0, 2147483647))->type_name("N");
  verb.add_option("--speed", o.speed, "how much faster than real time")->check(number_in(0.01, 1000.0))
      ->capture_default_str()->type_name("X");
  verb.add_option("--gone-after", o.gone_s, "a team-mate silent for this long is not waited for [s]")
      ->check(number_in(1.0, 1e6))->capture_default_str()->type_name("S");
}

}  // namespace outrider::app
