#pragma once
// Maps drawn in text: '#' occupied, '.' free, '?' unknown; letters and digits are free cells that a test can ask for.
// The top line is the highest row. Blank lines and blanks around a line are ignored, so raw strings may be indented.

#include <cctype>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "world/grid.hpp"

namespace outrider::test {

/// The drawn lines, bottom row first.
inline std::vector<std::string> ascii_rows(std::string_view text) {
  std::vector<std::string> rows;
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t eol = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, eol - at);
    at = eol + 1;
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.front()))) line.remove_prefix(1);
    while (!line.empty() && std::isspace(static_cast<unsigned char>(line.back()))) line.remove_suffix(1);
    if (line.empty()) continue;
    if (!rows.empty() && rows.front().size() != line.size()) throw std::invalid_argument("ASCII map with uneven lines");
    rows.insert(rows.begin(), std::string(line));
  }
  return rows;
}

inline CellState state_from_ascii(char c) {
  if (c == '#') return CellState::kOccupied;
  if (c == '?') return CellState::kUnknown;
  if (c == '.' || std::isalnum(static_cast<unsigned char>(c))) return CellState::kFree;
  throw std::invalid_argument(std::string("ASCII map with '") + c + "'");
}

/// The grid that `text` draws; its lower-left corner is at (0, 0).
inline OccupancyGrid grid_from_ascii(std::string_view text, double resolution = 1.0) {
  const auto rows = ascii_rows(text);
  const int height = static_cast<int>(rows.size());
  const int width = rows.empty() ? 0 : static_cast<int>(rows.front().size());
  OccupancyGrid map(GridGeometry{resolution, {0.0, 0.0}, width, height});
  for (std::size_t i = 0; i < map.size(); ++i) {
    const Cell c = map.geometry().cell_at(i);
    map[i] = state_from_ascii(rows[static_cast<std::size_t>(c.y)][static_cast<std::size_t>(c.x)]);
  }
  return map;
}

/// All cells drawn as `mark`, by ascending index.
inline std::vector<Cell> cells_marked(std::string_view text, char mark) {
  std::vector<Cell> cells;
  const auto rows = ascii_rows(text);
  for (std::size_t y = 0; y < rows.size(); ++y)
    for (std::size_t x = 0; x < rows[y].size(); ++x)
      if (rows[y][x] == mark) cells.push_back({static_cast<int>(x), static_cast<int>(y)});
  return cells;
}

/// The one cell drawn as `mark`.
inline Cell cell_marked(std::string_view text, char mark) {
  const auto cells = cells_marked(text, mark);
  if (cells.size() != 1) throw std::invalid_argument(std::string("ASCII map needs one '") + mark + "'");
  return cells.front();
}

/// A drawing of any grid: to_char(cell) names each cell. Highest row first, a newline after every row.
template <class ToChar>
std::string draw(const GridGeometry& g, ToChar&& to_char) {
  std::string text;
  for (int y = g.height - 1; y >= 0; --y) {
    for (int x = 0; x < g.width; ++x) text += to_char(Cell{x, y});
    text += '\n';
  }
  return text;
}

/// The drawing that grid_from_ascii reads, with marks over it (later ones win).
inline std::string to_ascii(const OccupancyGrid& map, const std::vector<std::pair<char, Cell>>& marks = {}) {
  return draw(map.geometry(), [&](Cell c) {
    char drawn = "?.#"[static_cast<int>(map[c])];
    for (const auto& [mark, cell] : marks)
      if (cell == c) drawn = mark;
    return drawn;
  });
}

/// `text` as to_ascii would draw it: without indentation and blank lines. For comparing with drawn expectations.
inline std::string tidy_ascii(std::string_view text) {
  std::string tidy;
  for (const std::string& row : ascii_rows(text)) tidy = row + '\n' + tidy;
  return tidy;
}

}  // namespace outrider::test
