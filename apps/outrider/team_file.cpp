#include "team_file.hpp"

#include <fmt/format.h>

#include <array>
#include <set>

#include "explorer/yaml_reader.hpp"

namespace outrider::app {
namespace {

const std::vector<std::string> kRobotKeys{"name", "start", "speed", "range", "fov", "beams", "radius"};

using Reader = explorer::YamlReader;

RobotSpec read_robot(const Reader& reader, const YAML::Node& node, std::size_t index) {
  if (!node.IsMap()) reader.fail(node, "expected a robot as {name, start, speed, range, fov, beams, radius}");
  reader.known_keys(node, kRobotKeys);
  RobotSpec robot;
  robot.name = node["name"] ? reader.text(node["name"], "name") : fmt::format("robot{}", index + 1);
  constexpr std::string_view kAllowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  if (robot.name.empty() || robot.name.find_first_not_of(kAllowed) != std::string::npos)
    reader.fail(node["name"], fmt::format("name: expected letters, digits, '_' or '-', not '{}'", robot.name));
  if (node["start"]) robot.start = reader.pose(node["start"], "start");
  if (node["speed"]) robot.speed = reader.number(node["speed"], "speed", 0.001, 100.0, "m/s");
  if (node["range"]) robot.range = reader.number(node["range"], "range", 0.01, 1000.0, "m");
  if (node["fov"]) robot.fov = reader.number(node["fov"], "fov", 0.01, 2.0 * kPi + 1e-6, "rad");
  if (node["beams"]) robot.beams = static_cast<int>(reader.number(node["beams"], "beams", 2, 100000, "beams"));
  if (node["radius"]) robot.radius = reader.number(node["radius"], "radius", 0.01, 100.0, "m");
  return robot;
}

}  // namespace

std::vector<RobotSpec> dai_team(double resolution) {
  constexpr std::array<double, 4> kSpeed{3, 4, 3, 2}, kRange{4, 8, 3, 4};
  const bool coarse = resolution >= 0.5;
  std::vector<RobotSpec> team(4);
  for (std::size_t i = 0; i < 4; ++i) {
    team[i].name = fmt::format("R{}", i + 1);
    team[i].speed = kSpeed[i] * (coarse ? resolution : 0.2);
    team[i].range = kRange[i] * (coarse ? resolution : 1.0);
    team[i].radius = coarse ? 0.45 * resolution : 0.2;
  }
  return team;
}

TeamFile read_team_file(const std::filesystem::path& path) {
  const Reader reader(path, "team file");
  const YAML::Node root = reader.load();
  if (!root.IsMap() || !root["robots"] || !root["robots"].IsSequence() || root["robots"].size() == 0)
    throw InputError(fmt::format("{}: expected 'robots: [{{name, start, speed, range, ...}}, ...]'", path.string()));
  reader.known_keys(root, {"robots"});
  TeamFile team;
  std::set<std::string> names;
  for (const YAML::Node& node : root["robots"]) {
    team.robots.push_back(read_robot(reader, node, team.robots.size()));
    team.has_start.push_back(node["start"].IsDefined());
    if (!names.insert(team.robots.back().name).second)
      reader.fail(node, fmt::format("name: '{}' is taken; names must differ", team.robots.back().name));
  }
  return team;
}

TeamFile usual_team(const sim::World& world, int n) {
  const auto models = world.team.empty() ? dai_team(world.map.geometry().resolution) : world.team;
  const std::size_t size = n > 0 ? static_cast<std::size_t>(n) : models.size();
  TeamFile team;
  for (std::size_t i = 0; i < size; ++i) {
    team.robots.push_back(models[i % models.size()]);
    team.robots.back().name = fmt::format("robot{}", i + 1);
    team.has_start.push_back(false);
  }
  return team;
}

std::vector<RobotSpec> place_team(const sim::World& world, TeamFile team) {
  if (std::find(team.has_start.begin(), team.has_start.end(), false) == team.has_start.end()) return team.robots;
  // Given starts count as the world's first; the others follow in the world's order.
  sim::World placed = world;
  std::vector<std::size_t> order;
  placed.starts.clear();
  for (const bool given : {true, false})
    for (std::size_t i = 0; i < team.robots.size(); ++i)
      if (team.has_start[i] == given) order.push_back(i);
  for (std::size_t i = 0; i < team.robots.size(); ++i)
    if (team.has_start[i]) placed.starts.push_back(team.robots[i].start);
  placed.starts.insert(placed.starts.end(), world.starts.begin(), world.starts.end());
  std::vector<double> radii;
  for (const std::size_t i : order) radii.push_back(team.robots[i].radius);
  const std::vector<Pose2> starts = sim::spread_starts(placed, radii);
  for (std::size_t k = 0; k < order.size(); ++k)
    if (!team.has_start[order[k]]) team.robots[order[k]].start = starts[k];
  return team.robots;
}

}  // namespace outrider::app
