// `outrider team`: a whole live team on this machine, one process a robot.

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>

#include "explorer/referee.hpp"
#include "link/event_log.hpp"
#include "link/lc02.hpp"
#include "link/multicast.hpp"
#include "link/private_network.hpp"
#include "link/team_key.hpp"
#include "live.hpp"
#include "live_team.hpp"
#include "maps_module.hpp"
#include "mission_record.hpp"
#include "progress.hpp"
#include "report/run_folder.hpp"
#include "sim/arena.hpp"
#include "specs.hpp"
#include "world/error.hpp"

namespace outrider::app {
namespace {

constexpr double kSaveTime = 10.0;  // [s] that interrupted robots get

struct Options {
  LiveOptions live;
  std::string fault;
  std::filesystem::path record, arena;
  bool private_network = false;
};

/// A network that carries multicast: this machine's, or one of our own.
std::string find_network(const Options& o) {
  std::string why;
  const link::MulticastUrl url = link::MulticastUrl::parse(o.live.url);
  if (!o.private_network && link::MulticastSocket::open(url, why)) return "this machine's network";
  if (link::enter_private_network() && link::MulticastSocket::open(url, why))
    return fmt::format("a private network (to listen in: nsenter --preserve-credentials -U -n -t {})", getpid());
  throw InputError(fmt::format("{}: {}; as root: ip route add 224.0.0.0/4 dev lo", o.live.url, why));
}

/// Writes everything on the air into a log, as lcm-logger does.
class Recorder {
 public:
  Recorder(const Options& o, std::string& why) {
    if (o.record.empty()) return;
    log_.emplace(o.record);
    socket_ = link::MulticastSocket::open(link::MulticastUrl::parse(o.live.url), why);
  }
  void drain() {
    std::array<std::uint8_t, 65536> buffer;
    while (socket_) {
      const auto size = socket_->receive(buffer);
      if (!size) return;
      const auto frame = link::parse_lc02({buffer.data(), *size});
      if (const auto* message = std::get_if<link::Lc02>(&frame)) log_->write(wall_clock_us(), message->channel, message->payload);
    }
  }

 private:
  static std::int64_t wall_clock_us() {
    using namespace std::chrono;
    return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
  }
  std::optional<link::EventLogWriter> log_;
  std::optional<link::MulticastSocket> socket_;
};

/// Where bodies meet: in memory, or in a file that robots started by hand can join.
std::filesystem::path make_arena(const Options& o, const std::vector<RobotSpec>& team) {
  std::filesystem::path file = o.arena;
  if (file.empty()) {
    const int memory = memfd_create("outrider-arena", 0);
    if (memory < 0) throw std::runtime_error(fmt::format("memfd_create: {}", std::strerror(errno)));
    file = fmt::format("/proc/self/fd/{}", memory);
  }
  std::vector<Pose2> starts;
  for (const RobotSpec& robot : team) starts.push_back(robot.start);
  sim::Arena::create(file, starts);
  return file;
}

/// Faults that happen to processes.
std::vector<explorer::Fault> process_faults(const Options& o, const std::vector<RobotSpec>& team) {
  auto faults = parse_faults(o.fault, team);
  for (const explorer::Fault& fault : faults)
    if (fault.kind != explorer::Fault::Kind::kKill && fault.kind != explorer::Fault::Kind::kRevive)
      throw InputError(fmt::format("--fault {}: a live team knows kill:ROBOT@T and revive:ROBOT@T", o.fault));
  return faults;
}

/// Share of the cells that somebody has seen, of those that can be seen: what progress shows.
class Seen {
 public:
  Seen(const OccupancyGrid& truth, const std::vector<RobotSpec>& team) : reachable_(explorer::reachable_area(truth, team)) {
    for (const std::uint8_t cell : reachable_.data()) all_ += cell;
  }
  double fraction(const std::vector<explorer::RobotJournal>& journals) {
    read_.resize(journals.size());
    for (std::size_t r = 0; r < journals.size(); ++r)
      for (; read_[r] < journals[r].entries.size(); ++read_[r])
        for (const std::uint32_t i : journals[r].entries[read_[r]].cells) seen_ += std::exchange(reachable_[i], std::uint8_t{0});
    return all_ == 0 ? 1.0 : static_cast<double>(seen_) / static_cast<double>(all_);
  }

 private:
  Grid<std::uint8_t> reachable_;
  std::vector<std::size_t> read_;
  std::size_t all_ = 0, seen_ = 0;
};

/// Runs the processes to their end. The run's clock is the arena's.
void watch_over(LiveTeam& robots, const Options& o, const sim::World& world, const std::vector<RobotSpec>& team, double begin_s,
                const Context& ctx) {
  std::string why;
  Recorder recorder(o, why);
  const auto faults = process_faults(o, team);
  std::size_t next_fault = 0;
  Seen seen(world.map, team);
  Progress progress("exploring", ctx.quiet);
  for (RobotId r = 0; r < static_cast<RobotId>(team.size()); ++r) robots.start(r);
  double told_s = 0.0;  // when they were interrupted
  const auto revives = [&] { return next_fault < faults.size() && told_s == 0.0 && faults[next_fault].kind == explorer::Fault::Kind::kRevive; };
  while (robots.anybody_left() || revives()) {
    robots.attend(0.02);
    recorder.drain();
    const double now_s = (monotonic_s() - begin_s) * o.live.speed;
    for (; next_fault < faults.size() && faults[next_fault].t <= now_s && told_s == 0.0; ++next_fault) {
      const auto& fault = faults[next_fault];
      if (fault.kind == explorer::Fault::Kind::kKill) robots.kill(fault.robot);
      else if (!robots.runs(fault.robot)) robots.start(fault.robot);
    }
    if (ctx.interrupted->load() && told_s == 0.0) {
      robots.interrupt();
      told_s = monotonic_s();
    }
    if (told_s > 0.0 && monotonic_s() > told_s + kSaveTime) return;  // the team's destructor is less patient
    progress.update(seen.fraction(robots.journals()), fmt::format("{:.0f} s", now_s));
  }
  recorder.drain();
}

void add_fault_events(report::RunRecord& record, const Options& o, const std::vector<RobotSpec>& team) {
  for (const explorer::Fault& fault : process_faults(o, team))
    record.events.push_back({{"t", fault.t}, {"event", "fault"}, {"robot", team[static_cast<std::size_t>(fault.robot)].name},
                             {"fault", fault.kind == explorer::Fault::Kind::kKill ? "kill" : "revive"}});
  std::stable_sort(record.events.begin(), record.events.end(),
                   [](const auto& a, const auto& b) { return a.value("t", 0.0) < b.value("t", 0.0); });
}

void team(Options o, Context& ctx) {
  if (!ctx.out.empty()) report::check_out_dir(ctx.out, ctx.force);
  const sim::World world = open_exploration_world(o.live.mission);
  const std::vector<RobotSpec> robots = team_of(o.live.mission, world, ctx.seed);
  mission_settings(o.live.mission, ctx.seed, robots);  // bad flags stop here, before any process
  process_faults(o, robots);
  if (!o.live.key_file.empty()) link::TeamKey::read(o.live.key_file);
  const std::string network = find_network(o);
  if (ctx.verbose) fmt::print(stderr, "outrider: on {}\n", network);
  if (o.live.run == 0) o.live.run = static_cast<std::int32_t>(getpid());
  const std::filesystem::path arena = make_arena(o, robots);
  const double begin_s = monotonic_s();
  LiveTeam team(robots.size(), world.map.geometry(), [&](RobotId self, const explorer::LineSink& journal) {
    const auto end = run_robot(o.live, world, robots, self, arena, ctx.seed, *ctx.interrupted, journal);
    return end == explorer::LiveEnd::kTeamDone ? kDone : kAimMissed;
  });
  watch_over(team, o, world, robots, begin_s, ctx);
  report::RunRecord record = live_record(o.live, world, robots, ctx.seed, team.journals(), monotonic_s() - begin_s);
  add_fault_events(record, o, robots);
  record.verb = "team";
  record.command = ctx.argv;
  if (!ctx.out.empty())
    report::write_run_folder(record, ctx.out, {ctx.force}, [&](const auto& folder) {
      maps_module().write_maps(record, folder, o.live.mission.octomap);
    });
  if (!o.arena.empty()) std::filesystem::remove(o.arena);
  const report::Json document = report::run_json(record);
  if (ctx.json) fmt::print("{}\n", document.dump(2));
  else if (!ctx.quiet) print_summary(record, document["result"], ctx);
  ctx.exit_code = exit_code(document["result"]);
}

}  // namespace

void add_team(CLI::App& app, Context& ctx) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("team", "a whole live team on this machine, one process a robot, over LCM");
  add_live_options(*verb, o->live);
  verb->add_option("--fault", o->fault, "kill:ROBOT@T (SIGKILL), revive:ROBOT@T (started anew); comma-separated")->type_name("SPEC");
  verb->add_option("--record", o->record, "write all traffic to an LCM log; 'outrider replay' reads it")->type_name("FILE.lcm");
  verb->add_option("--arena", o->arena, "file where simulated bodies meet, for robots started by hand")->type_name("FILE");
  verb->add_flag("--private-network", o->private_network, "in a network namespace of its own even when multicast works");
  add_run_flags(*verb, ctx);
  verb->callback([o, &ctx] { team(*o, ctx); });
}

}  // namespace outrider::app
