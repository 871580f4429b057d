// The text format of datasets/*.txt.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

#include "sim/world.hpp"
#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::sim {
namespace {

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  while (!text.empty()) {
    const auto end = std::min(text.find(separator), text.size());
    parts.push_back(trim(text.substr(0, end)));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

/// One text being read; remembers the line for messages.
class Reader {
 public:
  Reader(std::string_view source, World& world, double resolution)
      : source_(source), world_(world), resolution_(resolution) {}

  void read(std::string_view text) {
    const std::vector<std::string_view> lines = split(text, '\n');
    std::size_t map_line = 0;
    for (std::size_t i = 0; i < lines.size(); ++i)
      if (lines[i] == "map:") map_line = i + 1;
    for (line_ = 1; line_ < map_line; ++line_) read_header(lines[line_ - 1]);
    read_map(std::span(lines).subspan(map_line), map_line);
    place_team();
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}, line {}: {}", source_, line_, what));
  }

  double number(std::string_view text) const {
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
      fail(fmt::format("expected a number, not '{}'", text));
    return value;
  }

  int whole_number(std::string_view text) const {
    const double value = number(text);
    if (value != std::floor(value) || std::abs(value) > 1e6)
      fail(fmt::format("expected a whole number, not '{}'", text));
    return static_cast<int>(value);
  }

  std::vector<double> numbers(std::string_view text, std::size_t count) const {
    std::vector<double> values;
    for (const std::string_view word : split(text, ' '))
      if (!word.empty()) values.push_back(number(word));
    if (values.size() != count) fail(fmt::format("expected {} numbers, found {}", count, values.size()));
    return values;
  }

  void read_header(std::string_view line) {
    if (line.empty()) return;
    const auto colon = line.find(':');
    if (colon == std::string_view::npos) fail("expected 'key: value' before the line 'map:'");
    const std::string_view key = trim(line.substr(0, colon)), value = trim(line.substr(colon + 1));
    if (key == "provenance") {
      world_.provenance = value;
    } else if (key == "resolution") {
      resolution_ = number(value);
    } else if (key == "origin") {
      const auto xy = numbers(value, 2);
      origin_ = {xy[0], xy[1]};
    } else if (key == "start") {
      const auto pose = numbers(value, 3);
      world_.starts.push_back({pose[0], pose[1], pose[2]});
    } else if (key == "robot") {
      world_.team.push_back(robot(value));
    } else {
      fail(fmt::format("unknown key '{}'{}", key,
                       suggestion(key, {"map", "origin", "provenance", "resolution", "robot", "start"})));
    }
  }

  RobotSpec robot(std::string_view text) const {
    RobotSpec robot;
    const std::array<std::pair<std::string_view, double*>, 4> fields{
        {{"speed", &robot.speed}, {"range", &robot.range}, {"fov", &robot.fov}, {"radius", &robot.radius}}};
    for (const std::string_view word : split(text, ' ')) {
      if (word.empty()) continue;
      const auto equals = word.find('=');
      if (equals == std::string_view::npos) fail(fmt::format("expected key=value, not '{}'", word));
      const std::string_view key = word.substr(0, equals), value = word.substr(equals + 1);
      const auto field = std::find_if(fields.begin(), fields.end(), [&](const auto& f) { return f.first == key; });
      if (key == "name")
        robot.name = value;
      else if (key == "beams")
        robot.beams = whole_number(value);
      else if (field != fields.end())
        *field->second = number(value);
      else
        fail(fmt::format("unknown key '{}'{}", key,
                         suggestion(key, {"beams", "fov", "name", "radius", "range", "speed"})));
    }
    if (robot.name.empty()) fail("a robot needs a name");
    return robot;
  }

  void read_map(std::span<const std::string_view> rows, std::size_t first_line) {
    while (!rows.empty() && rows.back().empty()) rows = rows.first(rows.size() - 1);
    line_ = first_line + 1;
    if (rows.empty() || rows[0].empty()) fail("expected the rows of a map");
    if (!(resolution_ > 0.0)) fail(fmt::format("resolution {}: expected a positive number of m", resolution_));
    const GridGeometry g{resolution_, origin_, static_cast<int>(rows[0].size()), static_cast<int>(rows.size())};
    world_.map = OccupancyGrid(g);
    for (std::size_t i = 0; i < rows.size(); ++i, ++line_) {
      if (rows[i].size() != rows[0].size())
        fail(fmt::format("the row has {} cells, the first one {}", rows[i].size(), rows[0].size()));
      for (std::size_t x = 0; x < rows[i].size(); ++x)
        read_cell({static_cast<int>(x), g.height - 1 - static_cast<int>(i)}, rows[i][x]);
    }
    std::vector<Pose2> starts;
    for (const auto& start : digits_)
      if (start) starts.push_back(*start);
    world_.starts.insert(world_.starts.begin(), starts.begin(), starts.end());
  }

  void read_cell(Cell c, char symbol) {
    const bool digit = symbol >= '0' && symbol <= '9';
    if (symbol != '#' && symbol != '.' && !digit)
      fail(fmt::format("column {}: expected '#', '.' or a digit, not '{}'", c.x + 1, symbol));
    world_.map[c] = symbol == '#' ? CellState::kOccupied : CellState::kFree;
    if (!digit) return;
    std::optional<Pose2>& start = digits_[static_cast<std::size_t>(symbol - '0')];
    if (start) fail(fmt::format("column {}: start {} is there twice", c.x + 1, symbol));
    const Point p = world_.map.geometry().center(c);
    start = Pose2{p.x, p.y, 0.0};
  }

  void place_team() {
    line_ = 1;
    if (world_.team.size() > world_.starts.size()) fail("there are more robots than starts");
    for (std::size_t i = 0; i < world_.team.size(); ++i) world_.team[i].start = world_.starts[i];
  }

  std::string_view source_;
  World& world_;
  double resolution_;
  Point origin_;
  std::array<std::optional<Pose2>, 10> digits_;
  std::size_t line_ = 0;
};

}  // namespace

World parse_world(std::string_view text, std::string_view source, double resolution) {
  World world;
  world.name = source;
  Reader(source, world, resolution).read(text);
  return world;
}

}  // namespace outrider::sim
