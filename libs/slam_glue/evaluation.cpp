#include "slam_glue/evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <numeric>
#include <optional>

#include "slam_glue/gzip.hpp"
#include "world/error.hpp"

namespace outrider::slam_glue {
namespace {

constexpr double kDegrees = 180.0 / kPi;

/// The numbers of every line that is neither empty nor a comment.
template <class Visit>
void for_each_row(const std::filesystem::path& file, Visit&& visit) {
  GzipReader reader(file);
  std::string line;
  std::vector<double> row;
  while (reader.next_line(line)) {
    const std::string where = fmt::format("{}:{}", file.string(), reader.line_number());
    row.clear();
    const std::string_view text = std::string_view(line).substr(0, line.find('#'));
    for (std::size_t at = text.find_first_not_of(" \t,"); at != std::string_view::npos;) {
      const std::size_t end = std::min(text.find_first_of(" \t,", at), text.size());
      double value = 0.0;
      const auto [rest, error] = std::from_chars(text.data() + at, text.data() + end, value);
      if (error != std::errc{} || rest != text.data() + end || !std::isfinite(value))
        throw InputError(fmt::format("{}: expected a number, found '{}'", where,
                                     text.substr(at, std::min<std::size_t>(end - at, 40))));
      row.push_back(value);
      at = text.find_first_not_of(" \t,", end);
    }
    if (!row.empty()) visit(row, where);
  }
}

/// The pose at time t, where t lies between two poses at most `max_gap_s` apart.
std::optional<Pose2> interpolate(std::span<const TimedPose> poses, double t, double max_gap_s) {
  constexpr double kSlack = 1e-4;  // relations are written with fewer digits than logs [s]
  if (poses.empty() || t < poses.front().t - kSlack || t > poses.back().t + kSlack) return std::nullopt;
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), t, [](const TimedPose& p, double s) { return p.t < s; });
  if (after == poses.end()) return poses.back().pose;
  if (after == poses.begin() || after->t - t <= kSlack) return after->pose;
  const TimedPose &a = *(after - 1), &b = *after;
  if (t - a.t <= kSlack) return a.pose;
  if (b.t - a.t > max_gap_s) return std::nullopt;
  const double s = (t - a.t) / (b.t - a.t);
  return Pose2{a.pose.x + s * (b.pose.x - a.pose.x), a.pose.y + s * (b.pose.y - a.pose.y),
               wrap_angle(a.pose.theta + s * wrap_angle(b.pose.theta - a.pose.theta))};
}

/// Null for an empty list; the earlier of two equally near ones.
const TimedPose* nearest_in_time(std::span<const TimedPose> poses, double t) {
  if (poses.empty()) return nullptr;
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), t, [](const TimedPose& p, double s) { return p.t < s; });
  if (after == poses.begin()) return &*after;
  if (after == poses.end()) return &*(after - 1);
  return t - (after - 1)->t <= after->t - t ? &*(after - 1) : &*after;
}

/// The rigid transform that brings the positions `from` nearest to `to` in the sense of least squares.
Pose2 align(std::span<const Pose2> from, std::span<const Pose2> to) {
  const auto n = static_cast<double>(from.size());
  Point f, g;
  for (std::size_t i = 0; i < from.size(); ++i) {
    f = {f.x + from[i].x / n, f.y + from[i].y / n};
    g = {g.x + to[i].x / n, g.y + to[i].y / n};
  }
  double dot = 0.0, cross = 0.0;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Point a{from[i].x - f.x, from[i].y - f.y}, b{to[i].x - g.x, to[i].y - g.y};
    dot += a.x * b.x + a.y * b.y;
    cross += a.x * b.y - a.y * b.x;
  }
  const double theta = std::atan2(cross, dot), c = std::cos(theta), s = std::sin(theta);
  return {g.x - c * f.x + s * f.y, g.y - s * f.x - c * f.y, theta};
}

std::vector<double> squared(std::vector<double> values) {
  for (double& v : values) v *= v;
  return values;
}

}  // namespace

ErrorStatistics statistics(std::vector<double> errors) {
  if (errors.empty()) return {};
  std::sort(errors.begin(), errors.end());
  const auto n = static_cast<double>(errors.size());
  ErrorStatistics s;
  s.min = errors.front();
  s.max = errors.back();
  s.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / n;
  double squares = 0.0, deviations = 0.0;
  for (const double e : errors) {
    squares += e * e;
    deviations += (e - s.mean) * (e - s.mean);
  }
  s.rmse = std::sqrt(squares / n);
  s.std = std::sqrt(deviations / n);
  const std::size_t half = errors.size() / 2;
  s.median = errors.size() % 2 == 1 ? errors[half] : 0.5 * (errors[half - 1] + errors[half]);
  return s;
}

std::vector<Relation> load_relations(const std::filesystem::path& file) {
  std::vector<Relation> relations;
  for_each_row(file, [&](const std::vector<double>& row, const std::string& where) {
    if (row.size() != 8)
      throw InputError(fmt::format("{}: {} numbers; expected 't1 t2 x y z roll pitch yaw'", where, row.size()));
    relations.push_back({row[0], row[1], {row[2], row[3], wrap_angle(row[7])}});
  });
  if (relations.empty())
    throw InputError(fmt::format("{}: no relation; expected 't1 t2 x y z roll pitch yaw'", file.string()));
  return relations;
}

RelationErrors evaluate_relations(std::span<const TimedPose> trajectory, std::span<const Relation> relations,
                                  double max_gap_s) {
  RelationErrors result;
  result.total = relations.size();
  std::vector<double> translation, rotation;
  for (const Relation& r : relations) {
    const auto first = interpolate(trajectory, r.t1, max_gap_s), second = interpolate(trajectory, r.t2, max_gap_s);
    if (!first || !second) continue;
    const Pose2 error = inverse(r.T_1_2) * (inverse(*first) * *second);
    translation.push_back(std::hypot(error.x, error.y));
    rotation.push_back(std::abs(error.theta) * kDegrees);
  }
  result.used = translation.size();
  result.translation_sqr_m2 = statistics(squared(translation));
  result.rotation_sqr_deg2 = statistics(squared(rotation));
  result.translation_m = statistics(std::move(translation));
  result.rotation_deg = statistics(std::move(rotation));
  return result;
}

std::string cartographer_lines(const RelationErrors& e) {
  const auto line = [](const char* name, const ErrorStatistics& s, const char* unit) {
    return fmt::format("{} error {:.5f} +/- {:.5f} {}\n", name, s.mean, s.std, unit);
  };
  return line("Abs translational", e.translation_m, "m") + line("Sqr translational", e.translation_sqr_m2, "m^2") +
         line("Abs rotational", e.rotation_deg, "deg") + line("Sqr rotational", e.rotation_sqr_deg2, "deg^2");
}

PosePairs associate(std::span<const TimedPose> trajectory, std::span<const TimedPose> reference,
                    double max_difference_s, double max_gap_s) {
  const bool ours_shorter = trajectory.size() < reference.size();
  const auto shorter = ours_shorter ? trajectory : reference, longer = ours_shorter ? reference : trajectory;
  PosePairs pairs;
  for (const TimedPose& p : shorter) {
    const TimedPose* q = nearest_in_time(longer, p.t);
    if (q == nullptr || std::abs(q->t - p.t) > max_difference_s) continue;
    pairs.ours.push_back(ours_shorter ? p.pose : q->pose);
    pairs.reference.push_back(ours_shorter ? q->pose : p.pose);
  }
  if (2 * pairs.ours.size() < shorter.size() || pairs.ours.size() < 2) {
    pairs = {{}, {}, true};
    for (const TimedPose& p : trajectory)
      if (const auto truth = interpolate(reference, p.t, max_gap_s)) {
        pairs.ours.push_back(p.pose);
        pairs.reference.push_back(*truth);
      }
  }
  if (pairs.ours.size() < 2)
    throw InputError(fmt::format(
        "the reference covers {} poses of the trajectory; expected time stamps on the same clock", pairs.ours.size()));
  return pairs;
}

AteResult absolute_trajectory_error(const PosePairs& pairs) {
  AteResult result;
  result.matched = pairs.ours.size();
  result.T_reference_map = align(pairs.ours, pairs.reference);
  std::vector<double> errors;
  for (std::size_t i = 0; i < result.matched; ++i)
    errors.push_back(
        distance(result.T_reference_map * pairs.ours[i].position(), pairs.reference[i].position()));
  result.error_m = statistics(std::move(errors));
  return result;
}

RpeResult relative_pose_error(const PosePairs& pairs) {
  std::vector<double> metres, degrees;
  for (std::size_t i = 1; i < pairs.ours.size(); ++i) {
    const Pose2 step = inverse(pairs.ours[i - 1]) * pairs.ours[i];
    const Pose2 error = inverse(inverse(pairs.reference[i - 1]) * pairs.reference[i]) * step;
    metres.push_back(std::hypot(error.x, error.y));
    degrees.push_back(std::abs(error.theta) * kDegrees);
  }
  return {metres.size(), statistics(std::move(metres)), statistics(std::move(degrees))};
}

std::vector<TimedPose> load_trajectory(const std::filesystem::path& file) {
  std::vector<TimedPose> poses;
  std::size_t columns = 0;
  for_each_row(file, [&](const std::vector<double>& row, const std::string& where) {
    if (columns == 0) columns = row.size();
    if (row.size() != columns || (columns != 4 && columns != 8))
      throw InputError(
          fmt::format("{}: {} numbers; expected TUM's 't x y z qx qy qz qw' or 't x y theta'", where, row.size()));
    double theta = row[3];
    if (columns == 8) {
      const double qx = row[4], qy = row[5], qz = row[6], qw = row[7];
      if (qx * qx + qy * qy + qz * qz + qw * qw < 1e-6)
        throw InputError(fmt::format("{}: the quaternion is zero", where));
      theta = std::atan2(2.0 * (qw * qz + qx * qy), qw * qw + qx * qx - qy * qy - qz * qz);
    }
    poses.push_back({row[0], {row[1], row[2], wrap_angle(theta)}});
  });
  if (poses.empty())
    throw InputError(fmt::format("{}: no pose; expected 't x y z qx qy qz qw' or 't x y theta'", file.string()));
  std::stable_sort(poses.begin(), poses.end(), [](const TimedPose& a, const TimedPose& b) { return a.t < b.t; });
  return poses;
}

void save_tum(std::span<const TimedPose> trajectory, const std::filesystem::path& file) {
  std::ofstream out(file);
  for (const TimedPose& p : trajectory)
    out << fmt::format("{:.6f} {:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}\n", p.t, p.pose.x, p.pose.y,
                       std::sin(0.5 * p.pose.theta), std::cos(0.5 * p.pose.theta));
  out.flush();
  if (!out) throw std::runtime_error(fmt::format("{}: cannot be written completely", file.string()));
}

}  // namespace outrider::slam_glue
