#include "report/metrics.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "report/trajectory_crossings.hpp"

namespace outrider::report {

double path_length(std::span<const TimedPose> trajectory) {
  double length = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i)
    length += distance(trajectory[i - 1].pose.position(), trajectory[i].pose.position());
  return length;
}

std::optional<Grid<std::uint8_t>> seen_counts(std::span<const RobotRecord> robots) {
  if (robots.empty() || robots[0].seen.size() == 0) return std::nullopt;
  Grid<std::uint8_t> counts(robots[0].seen.geometry());
  for (const RobotRecord& robot : robots) {
    if (robot.seen.geometry() != counts.geometry()) return std::nullopt;
    for (std::size_t i = 0; i < counts.size(); ++i)
      if (robot.seen[i] != 0 && counts[i] < 255) ++counts[i];
  }
  return counts;
}

std::optional<SeenAreas> seen_areas(std::span<const RobotRecord> robots) {
  const auto counts = seen_counts(robots);
  if (!counts) return std::nullopt;
  std::array<std::size_t, 4> cells{};
  for (const std::uint8_t count : counts->data()) ++cells[std::min<std::size_t>(count, 3)];
  const double area = counts->geometry().cell_area();
  SeenAreas areas{static_cast<double>(cells[1]) * area, static_cast<double>(cells[2]) * area,
                  static_cast<double>(cells[3]) * area};
  for (const RobotRecord& robot : robots)
    areas.sum +=
        area * static_cast<double>(robot.seen.size() - static_cast<std::size_t>(std::count(
                                                           robot.seen.data().begin(), robot.seen.data().end(), 0)));
  return areas;
}

std::optional<double> time_to(std::span<const TimelineRow> timeline, double fraction) {
  for (const TimelineRow& row : timeline)
    if (row.explored_fraction >= fraction) return row.time_s;
  return std::nullopt;
}

double standard_deviation(std::span<const double> values) {
  if (values.empty()) return 0.0;
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double sum = 0.0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return std::sqrt(sum / n);
}

namespace {

bool is_judged(const OccupancyGrid& truth, Cell c) {
  if (!truth.contains(c) || truth[c] == CellState::kUnknown) return false;
  if (truth[c] == CellState::kFree) return true;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const Cell n{c.x + dx, c.y + dy};
      if (truth.contains(n) && truth[n] == CellState::kFree) return true;
    }
  return false;
}

/// Calls visit(index of the map's cell, its state, the true state) for every judged cell.
template <class Visit>
void for_judged_cells(const OccupancyGrid& map, const OccupancyGrid& truth, Visit&& visit) {
  const GridGeometry& g = map.geometry();
  const bool same = g == truth.geometry();
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Cell c = same ? g.cell_at(i) : truth.geometry().cell_of(g.center(g.cell_at(i)));
    if (is_judged(truth, c)) visit(i, map[i], truth[c]);
  }
}

double ratio(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

/// Keys of `result` in the order in which they are written; others follow as the run gave them.
constexpr std::array kResultOrder{"status",
                                  "explored_fraction",
                                  "explored_m2",
                                  "reachable_m2",
                                  "time_s",
                                  "time_to",
                                  "mission_time_s",
                                  "scans",
                                  "duration_s",
                                  "path_m",
                                  "share",
                                  "overlap",
                                  "workload_std",
                                  "trajectory_intersections",
                                  "intersections",
                                  "interactions",
                                  "messages",
                                  "auctions",
                                  "lower_bound_s",
                                  "competitive_ratio",
                                  "map_quality",
                                  "left"};

void derive_progress(const RunRecord& record, Json& derived) {
  if (record.timeline.empty()) return;
  derived["explored_fraction"] = record.timeline.back().explored_fraction;
  derived["explored_m2"] = record.timeline.back().explored_m2;
  derived["time_s"] = record.timeline.back().time_s;
  Json times = Json::object();
  for (const auto& [name, fraction] : {std::pair{"0.5", 0.5}, {"0.9", 0.9}, {"0.95", 0.95}, {"0.99", 0.99}}) {
    const auto t = time_to(record.timeline, fraction);
    times[name] = t ? Json(*t) : Json(nullptr);
  }
  derived["time_to"] = times;
}

void derive_team(const RunRecord& record, Json& derived) {
  if (record.robots.empty()) return;
  Json path = Json::object(), share = Json::object(), crossings = Json::object();
  std::vector<std::vector<TimedPose>> trajectories;
  std::vector<double> shares;
  double total = 0.0;
  for (const RobotRecord& robot : record.robots) total += robot.first_seen_m2;
  for (const RobotRecord& robot : record.robots) {
    trajectories.push_back(robot.trajectory);
    shares.push_back(total > 0.0 ? robot.first_seen_m2 / total : 0.0);
    path[robot.spec.name] = path_length(robot.trajectory);
    share[robot.spec.name] = shares.back();
  }
  const Crossings crossed = trajectory_crossings(trajectories);
  for (std::size_t i = 0; i < record.robots.size(); ++i) crossings[record.robots[i].spec.name] = crossed.per_robot[i];
  derived["path_m"] = path;
  if (total > 0.0) {
    derived["share"] = share;
    derived["workload_std"] = standard_deviation(shares);
  }
  derived["trajectory_intersections"] = crossed.count;
  derived["intersections"] = crossings;
}

void derive_overlap(const RunRecord& record, Json& derived) {
  const auto areas = seen_areas(record.robots);
  if (!areas) return;
  const double reachable = record.result.is_object() ? record.result.value("reachable_m2", 0.0) : 0.0;
  const double whole = reachable > 0.0 ? reachable : areas->explored();
  derived["overlap"] = {{"fraction", areas->overlap_fraction()},
                        {"sum_cov_minus_cov_team", whole > 0.0 ? (areas->sum - areas->explored()) / whole : 0.0},
                        {"seen_m2", {{"1", areas->once}, {"2", areas->twice}, {"3+", areas->more}}}};
}

}  // namespace

Grid<MapError> map_errors(const OccupancyGrid& map, const OccupancyGrid& truth) {
  Grid<MapError> errors(map.geometry());
  for_judged_cells(map, truth, [&](std::size_t i, CellState seen, CellState real) {
    if (seen == real) return;
    errors[i] = seen == CellState::kUnknown    ? MapError::kUnseen
                : seen == CellState::kOccupied ? MapError::kFalseWall
                                               : MapError::kMissedWall;
  });
  return errors;
}

MapQuality map_quality(const OccupancyGrid& map, const OccupancyGrid& truth) {
  std::array<std::array<std::size_t, 3>, 3> n{};  // [in the map][in truth]
  for_judged_cells(map, truth, [&](std::size_t, CellState seen, CellState real) {
    ++n[static_cast<std::size_t>(seen)][static_cast<std::size_t>(real)];
  });
  constexpr std::size_t kU = 0, kF = 1, kO = 2;
  return {.iou_occupied = ratio(n[kO][kO], n[kO][kO] + n[kO][kF] + n[kF][kO] + n[kU][kO]),
          .iou_free = ratio(n[kF][kF], n[kF][kF] + n[kF][kO] + n[kO][kF] + n[kU][kF]),
          .accuracy = ratio(n[kO][kO] + n[kF][kF], n[kO][kO] + n[kF][kF] + n[kO][kF] + n[kF][kO]),
          .precision = ratio(n[kO][kO], n[kO][kO] + n[kO][kF]),
          .recall = ratio(n[kO][kO], n[kO][kO] + n[kF][kO] + n[kU][kO])};
}

Json derive_result(const RunRecord& record) {
  Json known = Json::object();
  derive_progress(record, known);
  derive_team(record, known);
  derive_overlap(record, known);
  if (record.truth && record.map.size() > 0) {
    const MapQuality q = map_quality(record.map, *record.truth);
    known["map_quality"] = {{"iou_occupied", q.iou_occupied},
                            {"iou_free", q.iou_free},
                            {"accuracy", q.accuracy},
                            {"precision", q.precision},
                            {"recall", q.recall}};
  }
  if (record.result.is_object())
    for (const auto& [key, value] : record.result.items()) known[key] = value;
  Json ordered = Json::object();
  for (const char* key : kResultOrder)
    if (known.contains(key)) ordered[key] = known[key];
  for (const auto& [key, value] : known.items())
    if (!ordered.contains(key)) ordered[key] = value;
  return ordered;
}

}  // namespace outrider::report
