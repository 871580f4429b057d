#include "mission_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "explorer/lower_bound.hpp"
#include "explorer/referee.hpp"

namespace outrider::app {
namespace {

using report::Json;

double milli(double v) { return std::round(v * 1e3) / 1e3; }

/// Turns mission events into lines of events.jsonl. Cells become metres in the map frame.
class EventWriter {
 public:
  EventWriter(const GridGeometry& geometry, const std::vector<report::RobotRecord>& robots)
      : geometry_(geometry), robots_(robots) {}

  Json operator()(double t, const explorer::Event& event) const {
    Json line{{"t", milli(t)}};
    std::visit([&](const auto& e) { write(line, e); }, event);
    return line;
  }

 private:
  const std::string& name(RobotId robot) const { return robots_[static_cast<std::size_t>(robot)].spec.name; }
  Json at(Cell c) const {
    const Point p = geometry_.center(c);
    return {milli(p.x), milli(p.y)};
  }
  Json names(const std::vector<RobotId>& robots) const {
    Json list = Json::array();
    for (const RobotId robot : robots) list.push_back(name(robot));
    return list;
  }

  void write(Json& line, const explorer::GoalEvent& e) const {
    line["event"] = "goal";
    line["robot"] = name(e.robot);
    line["task"] = at(e.task.cell);
    line["stand"] = at(e.task.stand);
    line["distance_m"] = milli(e.distance_m);
    line["value"] = milli(e.value);
  }
  void write(Json& line, const explorer::TaskEndEvent& e) const {
    line["event"] = "task_end";
    line["robot"] = name(e.robot);
    line["task"] = at(e.task);
    line["how"] = e.how;
  }
  void write(Json& line, const explorer::PhaseEvent& e) const {
    line["event"] = "phase";
    line["robot"] = name(e.robot);
    line["phase"] = e.phase;
  }
  void write(Json& line, const explorer::FaultEvent& e) const {
    line["event"] = "fault";
    line["robot"] = name(e.robot);
    line["fault"] = e.what;
  }
  void write(Json& line, const explorer::BreakEvent& e) const {
    line["event"] = e.which.kind == link::Break::Kind::kSplit ? "split" : "break";
    line["what"] = e.begins ? "begin" : "end";
    line["from_s"] = milli(e.which.begin_s);
    line["to_s"] = milli(e.which.end_s);
    if (!e.which.robots.empty()) line["robots"] = names(e.which.robots);
  }
  void write(Json& line, const explorer::AuctionRecord& e) const {
    line["event"] = "auction";
    line["opener"] = name(e.round.opener);
    line["round"] = e.round.count;
    Json bids = Json::array();
    for (const BidSheet& sheet : e.sheets) {
      Json tasks = Json::array();  // [x, y, gain_m2, distance_m] each
      for (const BidEntry& entry : sheet.entries) {
        const Point p = geometry_.center(entry.task);
        tasks.push_back({milli(p.x), milli(p.y), milli(entry.gain), milli(entry.distance)});
      }
      bids.push_back({{"robot", name(sheet.robot)}, {"busy", sheet.busy},
                      {"explored_rate_m2_s", milli(sheet.explored_rate)}, {"tasks", std::move(tasks)}});
    }
    line["bids"] = std::move(bids);
    Json awards = Json::array();
    for (const Award& award : e.awards)
      awards.push_back({{"robot", name(award.robot)}, {"task", at(award.task)}, {"value", milli(award.value)}});
    line["awards"] = std::move(awards);
    line["unheard"] = names(e.unheard);
    const auction::RoundTime time = auction::round_time(auction::BidTable(e.sheets, geometry_), e.awards);
    line["travel_s"] = milli(time.awarded_s);  // of the awards; the optimal assignment of the same bids needs
    line["least_travel_s"] = milli(time.least_s);
  }

  const GridGeometry& geometry_;
  const std::vector<report::RobotRecord>& robots_;
};

Json result_json(const explorer::MissionResult& r) {
  Json time_to = Json::object();
  for (const auto& [fraction, time] : r.time_to)
    time_to[fmt::format("{}", fraction)] = time ? Json(milli(*time)) : Json();
  Json left = Json::array();
  for (const explorer::Left& l : r.left)
    left.push_back({{"frontier", {milli(l.frontier.x), milli(l.frontier.y)}}, {"m2", milli(l.unknown_m2)},
                    {"why", explorer::to_string(l.why)}});
  return {{"status", explorer::to_string(r.status)},
          {"explored_fraction", r.explored_fraction},
          {"reachable_m2", milli(r.reachable_m2)},
          {"time_s", milli(r.time_s)},
          {"time_to", time_to},
          {"mission_time_s", milli(r.mission_time_s)},
          {"interactions", {{"count", r.interactions}, {"time_s", milli(r.interaction_s)},
                            {"in_breaks", {{"count", r.interactions_in_breaks},
                                           {"time_s", milli(r.interaction_in_breaks_s)}}}}},
          {"messages", {{"sent", r.radio.sent}, {"delivered", r.radio.delivered}, {"bytes", r.radio.bytes}}},
          {"maps_equal", r.maps_equal},
          {"left", left}};
}

/// The bound for what the run had to see, and how far above it the run was.
void add_lower_bound(Json& json, const explorer::MissionResult& r, const explorer::MissionSettings& settings,
                     const OccupancyGrid& truth) {
  std::vector<RobotSpec> team;
  for (const explorer::MissionRobot& robot : r.robots) team.push_back(robot.spec);
  for (const explorer::Fault& fault : settings.faults)  // "slow" may also speed up
    if (fault.kind == explorer::Fault::Kind::kSlow && fault.factor > 1.0)
      team[static_cast<std::size_t>(fault.robot)].speed *= fault.factor;
  const double bound = explorer::lower_bound_s(truth, team, std::min(settings.until, explorer::Referee::kExplored),
                                               settings.sim.lidar);
  const bool reached = r.status == explorer::MissionStatus::kExplored && bound > 0.0;
  json["lower_bound_s"] = milli(bound);
  json["competitive_ratio"] = reached ? Json(milli(r.time_s / bound)) : Json();
}

/// How far all rounds were from assignments with the least total travel time.
void add_auction_gap(Json& json, const std::vector<Json>& events) {
  std::size_t rounds = 0;
  double travel = 0.0, least = 0.0;
  for (const Json& event : events) {
    if (event["event"] != "auction") continue;
    ++rounds;
    travel += event["travel_s"].get<double>();
    least += event["least_travel_s"].get<double>();
  }
  if (rounds == 0) return;
  json["auctions"] = {{"rounds", rounds}, {"travel_s", milli(travel)}, {"least_travel_s", milli(least)},
                      {"gap", least > 0.0 ? Json(milli(travel / least - 1.0)) : Json()}};
}

/// How far each robot was from where it believed itself to be; null when all knew.
Json localization_json(const std::vector<explorer::MissionRobot>& robots) {
  Json json;
  for (const explorer::MissionRobot& robot : robots)
    if (const auto& e = robot.localization)
      json[robot.spec.name] = {{"rmse_m", milli(e->rmse_m)}, {"max_m", milli(e->max_m)}, {"last_m", milli(e->last_m)}};
  return json;
}

}  // namespace

report::RunRecord mission_record(explorer::MissionResult&& result, const explorer::MissionSettings& settings,
                                 const OccupancyGrid& truth) {
  report::RunRecord record;
  record.verb = "explore";
  record.coordinator = settings.coordinator;
  record.result = result_json(result);
  add_lower_bound(record.result, result, settings, truth);
  const Json localization = localization_json(result.robots);
  if (!localization.is_null()) record.result["localization_error"] = localization;
  for (explorer::MissionRobot& robot : result.robots)
    record.robots.push_back({robot.spec, std::move(robot.trajectory), std::move(robot.map), std::move(robot.seen),
                             robot.first_seen_m2});
  const EventWriter to_json(truth.geometry(), record.robots);
  for (const auto& [t, event] : result.events) record.events.push_back(to_json(t, event));
  add_auction_gap(record.result, record.events);
  for (explorer::TimelinePoint& row : result.timeline)
    record.timeline.push_back({row.time_s, row.explored_fraction, row.explored_m2, std::move(row.robot_m2)});
  record.map = std::move(result.map);
  record.truth = truth;
  record.known_since = std::move(result.known_since);
  record.playback_step_s = result.playback_step_s;
  return record;
}

report::Json event_json(double t, const explorer::Event& event, const GridGeometry& geometry,
                        const std::vector<report::RobotRecord>& robots) {
  return EventWriter(geometry, robots)(t, event);
}

}  // namespace outrider::app
