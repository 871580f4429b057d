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
      if (robot.seen[i] && counts[i] < 255) ++counts[i];
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
    areas.sum += area * static_cast<double>(robot.seen.count());
  return areas;
}

std::optional<std::vector<PairOverlap>> pair_overlaps(std::span<const RobotRecord> robots) {
  const auto counts = seen_counts(robots);
  if (!counts) return std::nullopt;
  const std::size_t n = robots.size();
  std::vector<std::size_t> own(n, 0), both(n * n, 0), here;
  for (std::size_t i = 0; i < counts->size(); ++i) {
    here.clear();
    for (std::size_t r = 0, left = (*counts)[i]; r < n && (left > 0 || (*counts)[i] == 255); ++r)
      if (robots[r].seen[i]) here.push_back(r), --left;
    for (std::size_t k = 0; k < here.size(); ++k) {
      ++own[here[k]];
      for (std::size_t l = k + 1; l < here.size(); ++l) ++both[here[k] * n + here[l]];
    }
  }
  const double area = counts->geometry().cell_area();
  std::vector<PairOverlap> pairs;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = a + 1; b < n; ++b) {
      const double m2 = area * static_cast<double>(both[a * n + b]);
      const double smaller = area * static_cast<double>(std::min(own[a], own[b]));
      pairs.push_back({a, b, m2, smaller > 0.0 ? m2 / smaller : 0.0});
    }
  return pairs;
}

std::vector<double> wasted_m(const RunRecord& record) {
  const std::size_t n = record.robots.size();
  const auto complete = [n](const TimelineRow& row) { return row.robot_m2.size() == n; };
  if (record.timeline.empty() || !std::all_of(record.timeline.begin(), record.timeline.end(), complete)) return {};
  std::vector<double> wasted(n, 0.0);
  for (std::size_t r = 0; r < n; ++r) {
    const RobotRecord& robot = record.robots[r];
    std::size_t row = 0;
    for (std::size_t i = 1; i < robot.trajectory.size(); ++i) {
      // A step of the way belongs to the row in which it ends.
      const double t = robot.trajectory[i].t - robot.clock_s;
      while (row + 1 < record.timeline.size() && record.timeline[row].time_s < t) ++row;
      const double before = row > 0 ? record.timeline[row - 1].robot_m2[r] : 0.0;
      if (record.timeline[row].robot_m2[r] <= before)
        wasted[r] += distance(robot.trajectory[i - 1].pose.position(), robot.trajectory[i].pose.position());
    }
  }
  return wasted;
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
  const auto pairs = pair_overlaps(record.robots);
  if (!areas || !pairs) return;
  const double reachable = record.result.is_object() ? record.result.value("reachable_m2", 0.0) : 0.0;
  const double whole = reachable > 0.0 ? reachable : areas->explored();
  derived["overlap"] = {{"fraction", areas->overlap_fraction()},
                        {"sum_cov_minus_cov_team", whole > 0.0 ? (areas->sum - areas->explored()) / whole : 0.0},
                        {"seen_m2", {{"1", areas->once}, {"2", areas->twice}, {"3+", areas->more}}}};
  Json& overlap = derived["overlap"];
  const auto name = [&](std::size_t i) { return record.robots[i].spec.name; };
  overlap["pairs"] = Json::array();
  constexpr std::size_t kMany = 100;  // pairs; of more only those that have something in common
  for (const PairOverlap& pair : *pairs)
    if (pair.m2 > 0.0 || pairs->size() <= kMany)
      overlap["pairs"].push_back(
          {{"robots", {name(pair.a), name(pair.b)}}, {"m2", pair.m2}, {"share_of_smaller", pair.share_of_smaller}});
  const std::vector<double> wasted = wasted_m(record);
  for (std::size_t i = 0; i < wasted.size(); ++i) overlap["wasted_m"][name(i)] = wasted[i];
}

Json distances_json(const Distances& d) { return {{"mean", d.mean}, {"median", d.median}, {"max", d.max}}; }

Json quality_json(const RunRecord& record) {
  const MapQuality q = map_quality(record.map, *record.truth, record.T_truth_map);
  Json json{{"iou_occupied", q.iou_occupied},
            {"iou_free", q.iou_free},
            {"accuracy", q.accuracy},
            {"precision", q.precision},
            {"recall", q.recall},
            {"completeness", q.completeness},
            {"within_tolerance",
             {{"tolerance_m", q.tolerance_m},
              {"precision", q.precision_within},
              {"recall", q.recall_within},
              {"recall_seen", q.recall_seen}}},
            {"wall_to_truth_m", distances_json(q.wall_to_truth)},
            {"truth_to_wall_m", distances_json(q.truth_to_wall)}};
  if (!record.alignment.is_null()) json["alignment"] = record.alignment;
  return json;
}

}  // namespace

Json derive_result(const RunRecord& record) {
  Json known = Json::object();
  derive_progress(record, known);
  derive_team(record, known);
  derive_overlap(record, known);
  if (record.truth && record.map.size() > 0) known["map_quality"] = quality_json(record);
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
