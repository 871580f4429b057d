#include "slam_glue/text_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <fstream>
#include <sstream>

#include "world/error.hpp"

namespace outrider::slam_glue {
namespace {

std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw InputError(fmt::format("{}: cannot be read", file.string()));
  return std::move(text).str();
}

/// Lines without their ends; no empty lines at the end.
std::vector<std::string_view> split_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    std::string_view line = text.substr(0, end);
    if (line.ends_with('\r')) line.remove_suffix(1);
    lines.push_back(line);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

/// The number behind `key` in a line "key number"; InputError otherwise.
int header_number(std::string_view line, std::string_view key, const std::string& where) {
  int value = 0;
  if (line.starts_with(key)) {
    line.remove_prefix(key.size());
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    if (error == std::errc{} && value > 0) return value;
  }
  throw InputError(fmt::format("{}: expected '{} NUMBER' with a number above 0", where, key));
}

}  // namespace

OccupancyGrid ascii_map(std::string_view text, double resolution, std::vector<Point>* starts,
                        const std::string& name_for_errors) {
  const auto lines = split_lines(text);
  std::size_t width = 0;
  for (const auto line : lines) width = std::max(width, line.size());
  if (width == 0) throw InputError(fmt::format("{}: the map is empty", name_for_errors));
  if (width * lines.size() > kMostCells) throw InputError(fmt::format("{}: the map is too large", name_for_errors));
  OccupancyGrid map({resolution, {0.0, 0.0}, static_cast<int>(width), static_cast<int>(lines.size())});
  std::array<std::optional<Cell>, 10> digits;
  for (std::size_t row = 0; row < lines.size(); ++row) {
    for (std::size_t column = 0; column < lines[row].size(); ++column) {
      const Cell cell{static_cast<int>(column), static_cast<int>(lines.size() - 1 - row)};
      const char c = lines[row][column];
      const auto complain = [&](std::string_view what) {
        throw InputError(fmt::format("{}:{}: column {}: {}", name_for_errors, row + 1, column + 1, what));
      };
      if (c == '#') {
        map[cell] = CellState::kOccupied;
      } else if (c == '.' || c == ' ') {
        map[cell] = CellState::kFree;
      } else if (c >= '0' && c <= '9') {
        auto& digit = digits[static_cast<std::size_t>(c - '0')];
        if (digit) complain(fmt::format("start cell '{}' appears twice", c));
        digit = cell;
        map[cell] = CellState::kFree;
      } else if (c != '?') {
        const bool printable = c > 32 && c < 127;
        complain(
            fmt::format("unexpected {}; expected '#', '.', ' ', '?' or a digit",
                        printable ? fmt::format("'{}'", c) : fmt::format("byte {}", static_cast<unsigned char>(c))));
      }
    }
  }
  if (starts != nullptr) {
    starts->clear();
    for (const auto& digit : digits)
      if (digit) starts->push_back(map.geometry().center(*digit));
  }
  return map;
}

LoadedMap load_ascii(const std::filesystem::path& file, double resolution) {
  LoadedMap loaded;
  loaded.grid = ascii_map(read_text(file), resolution, &loaded.starts, file.string());
  return loaded;
}

OccupancyGrid load_moving_ai(const std::filesystem::path& file, double resolution) {
  const std::string text = read_text(file);
  const auto lines = split_lines(text);
  const std::string name = file.string();
  if (lines.size() < 4 || !lines[0].starts_with("type"))
    throw InputError(fmt::format("{}:1: expected the MovingAI header 'type octile'", name));
  const int height = header_number(lines[1], "height", name + ":2");
  const int width = header_number(lines[2], "width", name + ":3");
  if (lines[3] != "map") throw InputError(fmt::format("{}:4: expected 'map'", name));
  if (static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height) > kMostCells)
    throw InputError(fmt::format("{}: {} x {} cells are too many", name, width, height));
  if (lines.size() - 4 != static_cast<std::size_t>(height))
    throw InputError(fmt::format("{}: {} rows, but the header says height {}", name, lines.size() - 4, height));
  OccupancyGrid map({resolution, {0.0, 0.0}, width, height});
  for (int row = 0; row < height; ++row) {
    const std::string_view line = lines[static_cast<std::size_t>(row) + 4];
    if (line.size() != static_cast<std::size_t>(width))
      throw InputError(fmt::format("{}:{}: {} cells, but the header says width {}", name, row + 5, line.size(), width));
    for (int x = 0; x < width; ++x) {
      const char c = line[static_cast<std::size_t>(x)];
      if (std::string_view(".GS@OTW").find(c) == std::string_view::npos)
        throw InputError(
            fmt::format("{}:{}: column {}: '{}' is no MovingAI terrain (.GS@OTW)", name, row + 5, x + 1, c));
      // Ground and swamp can be driven on; out of bounds, trees and water cannot.
      map[{x, height - 1 - row}] = c == '.' || c == 'G' || c == 'S' ? CellState::kFree : CellState::kOccupied;
    }
  }
  return map;
}

}  // namespace outrider::slam_glue
