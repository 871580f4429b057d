// The text maps of CMU's Beesoft robots (wean.dat of "Probabilistic Robotics"): P(free) of every cell, column by column.

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>

#include "slam_glue/gzip.hpp"
#include "slam_glue/text_maps.hpp"
#include "world/error.hpp"

namespace outrider::slam_glue {
namespace {

constexpr double kFree = 0.804, kOccupied = 0.35;  // map_server's thresholds of P(occupied), 0.196 and 0.65

/// The numbers of a line; absent when something in it is none.
std::optional<std::vector<double>> numbers(std::string_view line) {
  std::vector<double> row;
  for (std::size_t at = line.find_first_not_of(" \t\r"); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    double value = 0.0;
    const auto [rest, error] = std::from_chars(line.data() + at, line.data() + end, value);
    if (error != std::errc{} || rest != line.data() + end || !std::isfinite(value)) return std::nullopt;
    row.push_back(value);
    at = line.find_first_not_of(" \t\r", end);
  }
  return row;
}

}  // namespace

OccupancyGrid load_beesoft(const std::filesystem::path& file) {
  GzipReader reader(file);
  const auto where = [&] { return fmt::format("{}:{}", file.string(), reader.line_number()); };
  double resolution_cm = 0.0;
  std::string line;
  std::vector<double> size;
  constexpr std::string_view kResolution = "robot_specifications->resolution", kMap = "global_map[0]:";
  while (size.empty() && reader.next_line(line)) {
    const std::string_view text = line;
    if (text.starts_with(kResolution)) {
      const auto value = numbers(text.substr(kResolution.size()));
      if (!value || value->size() != 1 || (*value)[0] <= 0.0)
        throw InputError(fmt::format("{}: expected '{} CENTIMETRES'", where(), kResolution));
      resolution_cm = (*value)[0];
    } else if (text.starts_with(kMap)) {
      size = numbers(text.substr(kMap.size())).value_or(std::vector<double>());
      if (size.size() != 2 || size[0] < 1.0 || size[1] < 1.0 || size[0] * size[1] > static_cast<double>(kMostCells))
        throw InputError(fmt::format("{}: expected '{} WIDTH HEIGHT'", where(), kMap));
    }
  }
  if (size.empty() || resolution_cm <= 0.0)
    throw InputError(fmt::format("{}: no Beesoft map; expected '{} CENTIMETRES' and '{} WIDTH HEIGHT'", file.string(),
                                 kResolution, kMap));
  OccupancyGrid map({0.01 * resolution_cm, {0.0, 0.0}, static_cast<int>(size[0]), static_cast<int>(size[1])});
  std::size_t k = 0;
  while (k < map.size() && reader.next_line(line)) {
    const auto row = numbers(line);
    if (!row || k + row->size() > map.size())
      throw InputError(fmt::format("{}: expected {} numbers in all, P(free) or -1", where(), map.size()));
    for (const double p : *row) {
      const auto height = static_cast<std::size_t>(map.height());
      const Cell c{static_cast<int>(k / height), static_cast<int>(k % height)};
      map[c] = p < 0.0 ? CellState::kUnknown : p > kFree ? CellState::kFree : p < kOccupied ? CellState::kOccupied
                                                                                           : CellState::kUnknown;
      ++k;
    }
  }
  if (k < map.size())
    throw InputError(fmt::format("{}: ends after {} of {} cells", file.string(), k, map.size()));
  return map;
}

}  // namespace outrider::slam_glue
