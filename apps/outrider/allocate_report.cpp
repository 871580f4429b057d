// What `outrider allocate` leaves behind: the result as JSON, in a sentence, and as a page.

#include <fmt/format.h>

#include "allocate.hpp"
#include "decision/route.hpp"
#include "report/run_folder.hpp"

namespace outrider::app {
namespace {

using explorer::AllocationResult;
using report::Json;
using report::Table;

const decision::Waypoint& goal_place(const AllocateMission& m, int goal) {
  return m.mission.map.waypoints[static_cast<std::size_t>(m.mission.goals[static_cast<std::size_t>(goal)])];
}

Json ids(const AllocateMission& m, const std::vector<int>& goals) {
  Json list = Json::array();
  for (const int g : goals) list.push_back(goal_place(m, g).id);
  return list;
}

report::MissionPicture picture_of(const AllocateMission& m, const AllocateOptions& o, const AllocationResult& result,
                                  const explorer::ExecutionResult* run) {
  const auto& map = m.mission.map;
  report::MissionPicture picture;
  picture.map = m.grid ? &*m.grid : nullptr;
  for (const auto& w : map.waypoints)
    picture.places.push_back({w.pose.position(), w.id, fmt::format("{}: {}, ({:.1f}, {:.1f}) m", w.id, to_string(w.state), w.pose.x, w.pose.y)});
  for (const int w : m.mission.goals) picture.places[static_cast<std::size_t>(w)].goal = true;
  for (std::size_t p = 0; p < map.paths.size(); ++p)
    picture.ways.push_back(decision::route_points(map, map.paths[p].from, {static_cast<int>(p)}));
  for (std::size_t i = 0; i < m.mission.robots.size(); ++i) {
    const auto& robot = m.mission.robots[i];
    report::MissionTour tour{robot.name, {}, {}};
    if (run != nullptr)
      for (const TimedPose& p : run->robots[i].trajectory) tour.driven.push_back(p.pose.position());
    int at = robot.own ? map.find(robot.own->waypoints[static_cast<std::size_t>(robot.at)].id).value_or(-1) : robot.at;
    std::vector<int> stops;
    for (std::size_t k = 0; k < result.order[i].size(); ++k) {
      const int w = m.mission.goals[static_cast<std::size_t>(result.order[i][k])];
      auto& place = picture.places[static_cast<std::size_t>(w)];
      place.owner = static_cast<int>(i);
      place.order = static_cast<int>(k) + 1;
      place.about += fmt::format("; goal {} of {}", k + 1, robot.name);
      stops.push_back(w);
    }
    if (o.return_home && at >= 0) stops.push_back(at);
    for (const int w : stops) {
      if (at < 0) break;
      const auto way = decision::route_points(map, at, decision::route(map, at, w));
      tour.way.insert(tour.way.end(), way.begin(), way.end());
      at = w;
    }
    picture.tours.push_back(std::move(tour));
  }
  return picture;
}

Table robots_table(const AllocateMission& m, const AllocationResult& result) {
  Table table{"Who does what", {"robot", "goals", "in this order", "mission [s at unit speed]", "modifications"}, {}, ""};
  for (std::size_t i = 0; i < m.mission.robots.size(); ++i) {
    std::string order;
    for (const int g : result.order[i]) order += (order.empty() ? "" : " ") + goal_place(m, g).id;
    table.rows.push_back({m.mission.robots[i].name, std::to_string(result.order[i].size()), order,
                          fmt::format("{:.2f}", result.mission_s[i]), std::to_string(result.modifications[i])});
  }
  return table;
}

/// The first and last utilities of SSA, robots by goals.
Table utilities_table(const AllocateMission& m, const explorer::AllocationStep& step) {
  Table table{fmt::format("Utilities of iteration {:.0f}, eq. 9", step.t), {"robot"}, {}, "in brackets: the owner afterwards"};
  const std::size_t goals = m.mission.goals.size();
  for (std::size_t g = 0; g < goals; ++g) table.columns.push_back(goal_place(m, static_cast<int>(g)).id);
  for (std::size_t i = 0; i < m.mission.robots.size(); ++i) {
    std::vector<std::string> row{m.mission.robots[i].name};
    for (std::size_t g = 0; g < goals; ++g)
      row.push_back(fmt::format(fmt::runtime(step.owners[g] == static_cast<int>(i) ? "[{:.1f}]" : "{:.1f}"),
                                step.utilities[i * goals + g]));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table execution_table(const AllocateMission& m, const explorer::ExecutionResult& run) {
  Table table{"As driven", {"robot", "goals reached", "driven [m]", "worst drift [m]", "topological control [%]", "planned anew"}, {},
              "drift: between where the robot believed to be and where it was"};
  for (std::size_t i = 0; i < run.robots.size(); ++i) {
    const auto& r = run.robots[i];
    table.rows.push_back({m.mission.robots[i].name, std::to_string(r.reached.size()), fmt::format("{:.1f}", r.path_m),
                          fmt::format("{:.2f}", r.worst_drift_m), fmt::format("{:.0f}", 100.0 * r.topological_share),
                          std::to_string(r.lost)});
  }
  return table;
}

Table protocol_table(const AllocateOptions& o, const AllocationResult& result) {
  Table table{"The negotiation", {"", ""}, {}, ""};
  table.rows = {{"protocol", o.protocol},
                {"duration of the mission [s at unit speed]", fmt::format("{:.2f}", result.duration)},
                {"movement, all robots [m]", fmt::format("{:.2f}", result.movement)},
                {"value, eq. 7", fmt::format("{:.2f}", result.value)},
                {"iterations", std::to_string(result.iterations)},
                {"messages", std::to_string(result.messages)},
                {"policies computed", std::to_string(result.policy_solves)}};
  if (result.negotiation_s > 0.0) table.rows.push_back({"negotiation [s simulated]", fmt::format("{:.2f}", result.negotiation_s)});
  return table;
}

}  // namespace

Json allocate_json(const AllocateMission& m, const AllocateOptions& o, const AllocationResult& result, const Context& ctx) {
  Json allocation = Json::object(), missions = Json::object(), modifications = Json::object(), steps = Json::array();
  for (std::size_t i = 0; i < m.mission.robots.size(); ++i) {
    const std::string& name = m.mission.robots[i].name;
    allocation[name] = ids(m, result.order[i]);
    missions[name] = result.mission_s[i];
    modifications[name] = result.modifications[i];
  }
  for (const auto& step : result.steps) {
    Json owners = Json::array();
    for (const int i : step.owners)
      owners.push_back(i < 0 ? Json() : Json(m.mission.robots[static_cast<std::size_t>(i)].name));
    Json entry{{"t", step.t}, {"value", step.value}, {"owners", owners}};
    if (!step.utilities.empty()) entry["utilities"] = step.utilities;
    steps.push_back(std::move(entry));
  }
  Json document{{"schema", 1}, {"outrider", OUTRIDER_VERSION}, {"verb", "allocate"}, {"command", ctx.argv}, {"seed", ctx.seed},
                {"mission", {{"name", m.name}, {"waypoints", m.mission.map.waypoints.size()}, {"paths", m.mission.map.paths.size()},
                             {"robots", m.mission.robots.size()}, {"goals", m.mission.goals.size()}}},
                {"configuration", {{"protocol", o.protocol}, {"noc", o.noc}, {"initial", o.initial}, {"gains", o.gains},
                                   {"comms", o.comms}, {"starts", o.starts}, {"return_home", o.return_home}}}};
  document["result"] = {{"status", !result.agreed ? "no_agreement" : result.undone.empty() ? "allocated" : "goals_left"},
                        {"allocation", allocation}, {"duration", result.duration}, {"movement", result.movement},
                        {"value", result.value}, {"iterations", result.iterations}, {"modifications", modifications},
                        {"messages", result.messages}, {"policy_solves", result.policy_solves},
                        {"mission_duration", missions}, {"negotiation_s", result.negotiation_s},
                        {"left", ids(m, result.undone)}, {"steps", steps}};
  return document;
}

Json execution_json(const AllocateMission& m, const explorer::ExecutionResult& run) {
  Json robots = Json::object();
  for (std::size_t i = 0; i < run.robots.size(); ++i) {
    const auto& r = run.robots[i];
    robots[m.mission.robots[i].name] = {{"reached", ids(m, r.reached)}, {"path_m", r.path_m}, {"worst_drift_m", r.worst_drift_m},
                                        {"topological_share", r.topological_share}, {"lost", r.lost}, {"done", r.done}};
  }
  return {{"status", run.interrupted ? "interrupted" : run.missed.empty() ? "all_reached" : "goals_missed"},
          {"time_s", run.time_s}, {"missed", ids(m, run.missed)}, {"worst_arrival_m", run.worst_arrival_m},
          {"rendezvous", run.rendezvous}, {"handed_over", run.handed_over}, {"robots", robots}};
}

std::string execution_verdict(const AllocateMission& m, const explorer::ExecutionResult& run) {
  double drift = 0.0, driven = 0.0;
  for (const auto& r : run.robots) drift = std::max(drift, r.worst_drift_m), driven += r.path_m;
  return fmt::format("Driven: {} of {} goals reached in {:.1f} s, {:.1f} m in all, worst drift {:.2f} m, {} rendezvous with {} goal{} "
                     "handed over", m.mission.goals.size() - run.missed.size(), m.mission.goals.size(), run.time_s, driven, drift,
                     run.rendezvous, run.handed_over, run.handed_over == 1 ? "" : "s");
}

void write_execution(const AllocateMission& m, const explorer::ExecutionResult& run, const std::filesystem::path& folder) {
  std::string events;
  for (const auto& e : run.events) {
    Json robots = Json::array();
    for (const int i : e.robots) robots.push_back(m.mission.robots[static_cast<std::size_t>(i)].name);
    Json line{{"t", e.t}, {"event", e.what}, {"robots", robots}};
    if (e.waypoint >= 0) line["waypoint"] = m.mission.map.waypoints[static_cast<std::size_t>(e.waypoint)].id;
    if (e.what == "rendezvous") line["handed_over"] = e.moved;
    events += report::to_text(line) + '\n';
  }
  report::write_file(folder / "events.jsonl", events);
  std::filesystem::create_directories(folder / "trajectories");
  for (std::size_t i = 0; i < run.robots.size(); ++i) {
    std::string tum;
    for (const TimedPose& p : run.robots[i].trajectory)
      tum += fmt::format("{:.3f} {:.4f} {:.4f} 0 0 0 {:.6f} {:.6f}\n", p.t, p.pose.x, p.pose.y, std::sin(p.pose.theta / 2.0), std::cos(p.pose.theta / 2.0));
    report::write_file(folder / "trajectories" / (m.mission.robots[i].name + ".tum"), tum);
  }
}

std::string allocate_verdict(const AllocateMission& m, const AllocateOptions& o, const AllocationResult& result) {
  return fmt::format("{}: {} of {} goals for {} robot{}; the longest mission takes {:.1f} s, {:.1f} m of movement in all; {} "
                     "iterations, {} messages", o.protocol, m.mission.goals.size() - result.undone.size(), m.mission.goals.size(),
                     m.mission.robots.size(), m.mission.robots.size() == 1 ? "" : "s", result.duration, result.movement,
                     result.iterations, result.messages);
}

std::string allocate_page(const AllocateMission& m, const AllocateOptions& o, const AllocationResult& result,
                          const explorer::ExecutionResult* run) {
  std::vector<std::pair<double, double>> curve;
  for (const auto& step : result.steps) curve.emplace_back(step.t, step.value);
  std::vector<Table> tables{robots_table(m, result), protocol_table(o, result)};
  if (run != nullptr) tables.push_back(execution_table(m, *run));
  if (!result.steps.empty() && !result.steps.back().utilities.empty() && m.mission.goals.size() <= 24) {
    constexpr std::size_t kMost = 12;
    for (std::size_t k = 0; k < std::min(kMost, result.steps.size()); ++k) tables.push_back(utilities_table(m, result.steps[k]));
  }
  const std::string verdict = allocate_verdict(m, o, result) + (run != nullptr ? ". " + execution_verdict(m, *run) : "");
  return report::mission_html(fmt::format("{} — {}", m.name, o.protocol), verdict,
                              picture_of(m, o, result, run),
                              report::curve_svg(curve, o.protocol == "ssa" ? "iteration" : "negotiation [s]", "value, eq. 7"), tables);
}

}  // namespace outrider::app
