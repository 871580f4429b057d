#pragma once
// Small run records for the tests, made by hand or drawn from a seed.

#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "report/run_record.hpp"

namespace outrider::report {

using Corners = std::vector<std::pair<double, double>>;

inline std::vector<TimedPose> drive(const Corners& corners) {
  std::vector<TimedPose> path;
  for (const auto& [x, y] : corners) path.push_back({static_cast<double>(path.size()), {x, y, 0.0}});
  return path;
}

/// Rows top first, as drawn: '#' occupied, '.' free, '?' unknown. One cell is 1 m.
inline OccupancyGrid ascii_map(const std::vector<std::string>& rows) {
  OccupancyGrid map({1.0, {0.0, 0.0}, static_cast<int>(rows[0].size()), static_cast<int>(rows.size())});
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Cell c = map.geometry().cell_at(i);
    const char symbol = rows[rows.size() - 1 - static_cast<std::size_t>(c.y)][static_cast<std::size_t>(c.x)];
    map[i] = symbol == '#' ? CellState::kOccupied : symbol == '.' ? CellState::kFree : CellState::kUnknown;
  }
  return map;
}

/// '1' where the robot saw the cell.
inline BitGrid ascii_seen(const std::vector<std::string>& rows) {
  BitGrid seen({1.0, {0.0, 0.0}, static_cast<int>(rows[0].size()), static_cast<int>(rows.size())});
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Cell c = seen.geometry().cell_at(i);
    if (rows[rows.size() - 1 - static_cast<std::size_t>(c.y)][static_cast<std::size_t>(c.x)] == '1') seen.insert(i);
  }
  return seen;
}

/// Two robots in a room of 4 x 2 cells; every field is filled.
inline RunRecord small_record() {
  RunRecord record;
  record.version = "1.2.3";
  record.verb = "explore";
  record.command = {"outrider", "explore", "room", "--robots", "2", "--out", "it's here"};
  record.seed = 7;
  record.world = {{"name", "room"}, {"width_m", 4.0}, {"height_m", 2.0}, {"resolution_m", 1.0}};
  record.coordinator = "daa";
  record.comms = "ideal";
  record.configuration = {{"sensing", "disc"}, {"until", 0.95}};
  record.robots.resize(2);
  record.robots[0].spec.name = "alice";
  record.robots[0].trajectory = drive({{0.5, 0.5}, {3.5, 0.5}});
  record.robots[0].seen = ascii_seen({"0000", "1111"});
  record.robots[0].first_seen_m2 = 4.0;
  record.robots[1].spec.name = "bob";
  record.robots[1].trajectory = drive({{1.5, 1.5}, {1.5, 0.25}});
  record.robots[1].seen = ascii_seen({"1100", "0110"});
  record.robots[1].first_seen_m2 = 2.0;
  record.map = ascii_map({"..??", "...#"});
  record.truth = ascii_map({"....", "...#"});
  record.playback_step_s = 0.5;
  record.known_since = Grid<std::uint16_t>(record.map.geometry(), 0);
  record.known_since[6] = record.known_since[7] = kNeverKnown;
  record.known_since[0] = 2;
  record.timeline = {{0.0, 0.25, 2.0, {1.0, 1.0}}, {1.0, 0.75, 6.0, {4.0, 2.0}}};
  record.events = {{{"t", 0.0}, {"event", "goal"}, {"robot", "alice"}, {"goal", {3.5, 0.5}}},
                   {{"t", 0.5}, {"event", "auction"}, {"bids", {{{"robot", "bob"}, {"value", 3.5}}}}}};
  record.result = {{"status", "unreachable_left"},
                   {"reachable_m2", 8.0},
                   {"messages", {{"sent", 12}, {"delivered", 11}, {"bytes", 3456}}},
                   {"left", {{{"frontier", {2.5, 1.5}}, {"m2", 2.0}, {"why", "too narrow"}}}}};
  record.timing = {{"wall_s", 0.0123}};
  return record;
}

}  // namespace outrider::report
