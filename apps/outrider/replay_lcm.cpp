#include "replay_lcm.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "explorer/overheard.hpp"
#include "link/event_log.hpp"
#include "live.hpp"
#include "maps_module.hpp"
#include "mission_record.hpp"
#include "report/run_folder.hpp"
#include "world/error.hpp"

namespace outrider::app {
namespace {

using report::Json;

constexpr double kStep = 0.5;  // of playback and timeline [s]

/// A recording, heard from its beginning to its end.
struct Recording {
  explorer::Overheard team{0, {}};
  Grid<std::uint16_t> known_since;
  std::vector<double> known_m2;  ///< by playback step
  double duration_s = 0.0;
  std::uint64_t events = 0, skipped_bytes = 0;
};

void note_news(Recording& r, double t) {
  auto& map = r.team.map();
  if (r.known_since.size() == 0) r.known_since = Grid<std::uint16_t>(map.states().geometry(), report::kNeverKnown);
  const auto step = static_cast<std::uint16_t>(std::clamp(t / kStep, 0.0, static_cast<double>(report::kNeverKnown - 1)));
  r.known_m2.resize(std::max<std::size_t>(r.known_m2.size(), step + std::size_t{1}), 0.0);
  for (const std::uint32_t i : map.take_changed()) {
    if (r.known_since[i] != report::kNeverKnown) continue;
    r.known_since[i] = step;
    if (map.states()[i] == CellState::kFree) r.known_m2[step] += map.states().geometry().cell_area();
  }
}

Recording listen_to(const std::filesystem::path& log, const Context& ctx) {
  Recording r;
  link::EventLogReader reader(log);
  std::optional<std::int64_t> first_us;
  while (const auto event = reader.next()) {
    if (ctx.interrupted->load()) break;
    ++r.events;
    const double wall_s = static_cast<double>(event->time_us - first_us.value_or(event->time_us)) * 1e-6;
    const double t = wall_s * r.team.introduction().time_scale;
    if (!r.team.hear(event->channel, event->data, t)) continue;
    if (!first_us) first_us = event->time_us;
    note_news(r, t);
    r.duration_s = t;
  }
  r.skipped_bytes = reader.skipped_bytes();
  if (!r.team.introduced())
    throw InputError(fmt::format("{}: no robot introduces itself in these {} messages; expected the traffic of a live team "
                                 "('outrider team --record', or lcm-logger)", log.string(), r.events));
  return r;
}

void add_timeline(const Recording& r, report::RunRecord& record) {
  double all = 0.0, so_far = 0.0;
  for (const double m2 : r.known_m2) all += m2;
  for (std::size_t k = 0; k < r.known_m2.size(); ++k) {
    so_far += r.known_m2[k];
    record.timeline.push_back({static_cast<double>(k) * kStep, all > 0.0 ? so_far / all : 0.0, so_far,
                               std::vector<double>(record.robots.size(), 0.0)});
  }
}

report::RunRecord record_of(Recording& r, bool& equal) {
  report::RunRecord record;
  record.verb = "replay";
  record.map = r.team.map().states();
  record.known_since = r.known_since;
  record.playback_step_s = kStep;
  record.coordinator = r.team.introduction().coordinator;
  Json robots = Json::object();
  equal = true;
  for (RobotId id = 0; id < r.team.introduction().team; ++id) {
    const auto known = r.team.robots().find(id);
    if (known == r.team.robots().end()) {  // events name robots by their place in the team
      record.robots.push_back({.spec = {.name = fmt::format("robot{}", id + 1)}, .seen = BitGrid(record.map.geometry())});
      continue;
    }
    const explorer::OverheardRobot& heard = known->second;
    report::RobotRecord robot{heard.spec, heard.trajectory, {}, BitGrid(record.map.geometry()), 0.0};
    if (robot.spec.name.empty()) robot.spec.name = fmt::format("robot{}", id + 1);
    const bool same = heard.status && heard.status->map_hash == r.team.map().hash();
    equal = equal && same;
    robot.map = same ? record.map : heard.said->states();
    for (std::size_t i = 0; i < robot.seen.size(); ++i)
      if (heard.said->states()[i] != CellState::kUnknown) robot.seen.insert(i);
    robots[robot.spec.name] = {{"map_as_in_the_run", same}, {"done", heard.status && heard.status->done}};
    record.robots.push_back(std::move(robot));
  }
  add_timeline(r, record);
  for (const auto& auction : r.team.auctions())
    record.events.push_back(event_json(auction.t, auction, record.map.geometry(), record.robots));
  record.result = {{"status", "replayed"}, {"duration_s", r.duration_s}, {"maps_as_in_the_run", equal}, {"robots", robots},
                   {"messages", {{"delivered", r.team.heard()}, {"bytes", r.team.bytes()}}},
                   {"events", r.events}, {"skipped_bytes", r.skipped_bytes}};
  return record;
}

}  // namespace

void replay_lcm(const std::filesystem::path& log, Context& ctx) {
  const double begin_s = monotonic_s();
  Recording recording = listen_to(log, ctx);
  bool equal = false;
  report::RunRecord record = record_of(recording, equal);
  record.version = OUTRIDER_VERSION;
  record.command = ctx.argv;
  record.seed = ctx.seed;
  record.configuration = {{"log", log.string()}};
  record.timing = {{"wall_s", monotonic_s() - begin_s}};
  if (!ctx.out.empty())
    report::write_run_folder(record, ctx.out, {ctx.force}, [&](const auto& folder) { maps_module().write_maps(record, folder, true); });
  if (ctx.json) fmt::print("{}\n", report::run_json(record).dump(2));
  else if (!ctx.quiet)
    fmt::print("replayed: {} robots, {:.0f} s, {} messages; the robots' last maps {} the one rebuilt{}\n", record.robots.size(),
               recording.duration_s, recording.team.heard(), equal ? "equal" : "differ from",
               ctx.out.empty() ? std::string() : fmt::format("; report: {}", (ctx.out / "report.html").string()));
  ctx.exit_code = ctx.interrupted->load() ? kInterrupted : equal ? kDone : kAimMissed;
}

}  // namespace outrider::app
