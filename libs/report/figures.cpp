#include "report/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>

namespace outrider::report {
namespace {

/// The value at a path of keys, if it is there.
const Json* find(const Json& json, std::initializer_list<const char*> path) {
  const Json* at = &json;
  for (const char* key : path) {
    if (!at->is_object() || !at->contains(key)) return nullptr;
    at = &(*at)[key];
  }
  return at;
}

std::optional<double> number(const Json& json, std::initializer_list<const char*> path) {
  const Json* value = find(json, path);
  return value != nullptr && value->is_number() ? std::optional(value->get<double>()) : std::nullopt;
}

std::string text(const Json& json, std::initializer_list<const char*> path) {
  const Json* value = find(json, path);
  return value != nullptr && value->is_string() ? value->get<std::string>() : "";
}

std::string spaced(std::string words) {
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

/// Sum and maximum of an object of numbers.
std::optional<std::pair<double, double>> sum_and_max(const Json& result, const char* key) {
  const Json* values = find(result, {key});
  if (values == nullptr || !values->is_object() || values->empty()) return std::nullopt;
  double sum = 0.0, most = 0.0;
  for (const auto& [name, value] : values->items()) {
    if (!value.is_number()) return std::nullopt;
    sum += value.get<double>();
    most = std::max(most, value.get<double>());
  }
  return std::pair(sum, most);
}

std::string percent(double fraction) { return fmt::format("{:.1f} %", 100.0 * fraction); }

using Value = std::function<std::string(const Json& result)>;

/// A figure that is one number: "{:.1f} m" and the like, after multiplication by `scale`.
Value plain(std::vector<const char*> path, std::string format, double scale = 1.0) {
  return [=](const Json& result) -> std::string {
    const Json* at = &result;
    for (const char* key : path) at = at != nullptr ? find(*at, {key}) : nullptr;
    if (at == nullptr || !at->is_number()) return "";
    return fmt::format(fmt::runtime(format), at->get<double>() * scale);
  };
}

std::string explored(const Json& result) {
  const auto fraction = number(result, {"explored_fraction"});
  const auto reachable = number(result, {"reachable_m2"});
  const auto area = number(result, {"explored_m2"});
  if (fraction && reachable) return fmt::format("{} of {:.1f} m²", percent(*fraction), *reachable);
  if (area) return fmt::format("{:.1f} m²", *area);
  return fraction ? percent(*fraction) : "";
}

std::string left_over(const Json& result) {
  const Json* left = find(result, {"left"});
  if (left == nullptr || !left->is_array()) return "";
  double m2 = 0.0;
  for (const Json& place : *left) m2 += number(place, {"m2"}).value_or(0.0);
  if (left->empty()) return "nothing";
  return fmt::format("{} place{}, {:.1f} m²", left->size(), left->size() == 1 ? "" : "s", m2);
}

std::string interactions(const Json& result) {
  const auto count = number(result, {"interactions", "count"}), time = number(result, {"interactions", "time_s"});
  if (!count) return "";
  return time ? fmt::format("{:.0f} ({:.1f} s)", *count, *time) : fmt::format("{:.0f}", *count);
}

std::string mission_time(const Json& result) {  // shown where it says more than the time of exploration
  const auto mission = number(result, {"mission_time_s"}), time = number(result, {"time_s"});
  return mission && mission != time ? fmt::format("{:.1f} s", *mission) : "";
}

std::string relations(const Json& result) {
  const auto mean = number(result, {"relations", "translation_m", "mean"});
  const auto std = number(result, {"relations", "translation_m", "std"});
  return mean ? fmt::format("{:.4f} ± {:.4f} m", *mean, std.value_or(0.0)) : "";
}

/// Precision within the tolerance that the run was measured with.
std::string near_truth(const Json& result) {
  const auto share = number(result, {"map_quality", "within_tolerance", "precision"});
  const auto tolerance = number(result, {"map_quality", "within_tolerance", "tolerance_m"});
  return share && tolerance ? fmt::format("{} within {:.2f} m", percent(*share), *tolerance) : "";
}

/// Sum of an object of metres.
Value total_figure(std::vector<const char*> path) {
  return [=](const Json& result) -> std::string {
    const Json* at = &result;
    for (std::size_t i = 0; at != nullptr && i + 1 < path.size(); ++i) at = find(*at, {path[i]});
    const auto sum = at != nullptr ? sum_and_max(*at, path.back()) : std::nullopt;
    return sum ? fmt::format("{:.1f} m", sum->first) : "";
  };
}

Value path_figure(bool total) {
  return [=](const Json& result) -> std::string {
    const auto path = sum_and_max(result, "path_m");
    return path ? fmt::format("{:.1f} m", total ? path->first : path->second) : "";
  };
}

/// Every row of the table, in order; the values are made from `result`.
const std::vector<std::pair<std::string, Value>>& catalogue() {
  static const std::vector<std::pair<std::string, Value>> kRows{
      {"status", [](const Json& r) { return spaced(text(r, {"status"})); }},
      {"explored", explored},
      {"exploration time", plain({"time_s"}, "{:.1f} s")},
      {"mission time", mission_time},
      {"time to 50 %", plain({"time_to", "0.5"}, "{:.1f} s")},
      {"time to 90 %", plain({"time_to", "0.9"}, "{:.1f} s")},
      {"time to 95 %", plain({"time_to", "0.95"}, "{:.1f} s")},
      {"time to 99 %", plain({"time_to", "0.99"}, "{:.1f} s")},
      {"lower bound of time", plain({"lower_bound_s"}, "{:.1f} s")},
      {"competitive ratio", plain({"competitive_ratio"}, "{:.2f}")},
      {"scans", plain({"scans"}, "{:.0f}")},
      {"duration of the log", plain({"duration_s"}, "{:.1f} s")},
      {"SLAM",
       [](const Json& r) {
         return text(r, {"slam", "method"});
       }},
      {"loop closures", plain({"slam", "loop_closures"}, "{:.0f}")},
      {"relations, translation", relations},
      {"absolute trajectory error", plain({"ate_m", "rmse"}, "{:.3f} m rmse")},
      {"relative pose error", plain({"rpe", "translation_m", "rmse"}, "{:.3f} m rmse a scan")},
      {"path, whole team", path_figure(true)},
      {"path, longest", path_figure(false)},
      {"overlap", plain({"overlap", "fraction"}, "{:.1f} %", 100.0)},
      {"driven without news", total_figure({"overlap", "wasted_m"})},
      {"Σ coverage − team's", plain({"overlap", "sum_cov_minus_cov_team"}, "{:+.3f}")},
      {"spread of shares (std)", plain({"workload_std"}, "{:.3f}")},
      {"trajectory crossings", plain({"trajectory_intersections"}, "{:.0f}")},
      {"interactions", interactions},
      {"auction rounds", plain({"auctions", "rounds"}, "{:.0f}")},
      {"travel above the optimal assignment", plain({"auctions", "gap"}, "{:.1f} %", 100.0)},
      {"messages sent", plain({"messages", "sent"}, "{:.0f}")},
      {"messages delivered", plain({"messages", "delivered"}, "{:.0f}")},
      {"data sent", plain({"messages", "bytes"}, "{:.1f} kB", 1e-3)},
      {"map, IoU of walls", plain({"map_quality", "iou_occupied"}, "{:.3f}")},
      {"map, IoU of free space", plain({"map_quality", "iou_free"}, "{:.3f}")},
      {"map, accuracy", plain({"map_quality", "accuracy"}, "{:.3f}")},
      {"map, precision of walls", plain({"map_quality", "precision"}, "{:.3f}")},
      {"map, recall of walls", plain({"map_quality", "recall"}, "{:.3f}")},
      {"map, completeness", plain({"map_quality", "completeness"}, "{:.1f} %", 100.0)},
      {"map, walls near true ones", near_truth},
      {"map, wall to true wall", plain({"map_quality", "wall_to_truth_m", "mean"}, "{:.3f} m mean")},
      {"scan ends on walls of the map", plain({"self_consistency", "end_points_agree"}, "{:.1f} %", 100.0)},
      {"beams through walls of the map", plain({"self_consistency", "seen_through"}, "{:.1f} %", 100.0)},
      {"doubled walls", plain({"self_consistency", "doubled_walls"}, "{:.1f} %", 100.0)},
      {"left unexplored", left_over},
  };
  return kRows;
}

/// Columns that a terminal needs for UTF-8 text without combining or wide characters.
std::size_t columns(const std::string& utf8) {
  return static_cast<std::size_t>(
      std::count_if(utf8.begin(), utf8.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

std::string counted_robots(const Json& run) {
  const Json* team = find(run, {"team"});
  const std::size_t n = team != nullptr && team->is_array() ? team->size() : 0;
  return fmt::format("{} robot{}", n, n == 1 ? "" : "s");
}

}  // namespace

std::vector<FigureRow> figure_rows(std::span<const Json> runs) {
  std::vector<FigureRow> rows;
  for (const auto& [label, value] : catalogue()) {
    FigureRow row{label, {}};
    for (const Json& run : runs) {
      const Json* result = find(run, {"result"});
      row.values.push_back(result != nullptr ? value(*result) : "");
    }
    if (std::any_of(row.values.begin(), row.values.end(), [](const auto& v) { return !v.empty(); }))
      rows.push_back(std::move(row));
  }
  return rows;
}

std::string verdict(const Json& run) {
  const Json* found = find(run, {"result"});
  const Json result = found != nullptr ? *found : Json::object();
  if (const auto scans = number(result, {"scans"})) {
    std::string words = fmt::format("{:.0f} scans of {}", *scans, counted_robots(run));
    if (const auto duration = number(result, {"duration_s"})) words += fmt::format(" over {:.1f} s", *duration);
    if (const auto area = number(result, {"explored_m2"})) words += fmt::format(" mapped {:.1f} m²", *area);
    return words + ".";
  }
  const std::string area = explored(result);
  if (area.empty()) return counted_robots(run) + "; nothing is known of what was explored.";
  std::string words = counted_robots(run) + " explored " + area;
  if (const auto time = number(result, {"time_s"})) words += fmt::format(" in {:.1f} s", *time);
  const std::string status = text(result, {"status"});
  if (status == "explored" || status.empty()) return words + ".";
  if (status == "unreachable_left") return words + "; what is left could not be reached.";
  if (status == "timeout") return words + ", then the time was up.";
  return words + "; the run ended as “" + spaced(status) + "”.";
}

std::string figure_table(std::span<const FigureRow> rows, std::span<const std::string> names) {
  std::vector<FigureRow> lines;
  if (!names.empty()) lines.push_back({"", {names.begin(), names.end()}});
  lines.insert(lines.end(), rows.begin(), rows.end());
  std::size_t first = 0;
  std::vector<std::size_t> widths;
  for (const FigureRow& line : lines) {
    first = std::max(first, columns(line.label));
    widths.resize(std::max(widths.size(), line.values.size()));
    for (std::size_t i = 0; i < line.values.size(); ++i) widths[i] = std::max(widths[i], columns(line.values[i]));
  }
  std::string out;
  for (const FigureRow& line : lines) {
    out += line.label + std::string(first - columns(line.label), ' ');
    for (std::size_t i = 0; i < line.values.size(); ++i) {
      const std::string shown = line.values[i].empty() ? "-" : line.values[i];
      out += "  " + std::string(widths[i] - std::min(widths[i], columns(shown)), ' ') + shown;
    }
    while (out.ends_with(' ')) out.pop_back();
    out += '\n';
  }
  return out;
}

}  // namespace outrider::report
