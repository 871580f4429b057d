#include "team_file.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <fstream>
#include <set>

#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::app {
namespace {

const std::vector<std::string> kRobotKeys{"name", "start", "speed", "range", "fov", "beams", "radius"};

/// A YAML reader that knows the file's name, so that every complaint can say where.
class Reader {
 public:
  explicit Reader(std::filesystem::path path) : path_(std::move(path)) {}

  [[noreturn]] void fail(const YAML::Node& node, const std::string& what) const {
    const YAML::Mark mark = node.Mark();
    throw InputError(mark.is_null() ? fmt::format("{}: {}", path_.string(), what)
                                    : fmt::format("{}:{}: {}", path_.string(), mark.line + 1, what));
  }

  std::string text(const YAML::Node& node, const char* what) const {
    if (!node.IsScalar()) fail(node, fmt::format("expected text as {}, not a list or a map", what));
    return node.Scalar();
  }

  void known_keys(const YAML::Node& map, const std::vector<std::string>& keys) const {
    for (const auto& pair : map) {
      const std::string key = text(pair.first, "a key");
      if (std::find(keys.begin(), keys.end(), key) == keys.end())
        fail(pair.first, fmt::format("unknown key '{}'{}", key, suggestion(key, keys)));
    }
  }

  double number(const YAML::Node& node, const std::string& key, double low, double high, const char* unit) const {
    double value = 0.0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !(value >= low && value <= high))
      fail(node, fmt::format("{}: expected a number from {} to {} {}", key, low, high, unit));
    return value;
  }

  Pose2 pose(const YAML::Node& node) const {
    if (!node.IsSequence() || node.size() < 2 || node.size() > 3)
      fail(node, "start: expected [x, y, theta] in metres and radians");
    return {number(node[0], "start x", -1e6, 1e6, "m"), number(node[1], "start y", -1e6, 1e6, "m"),
            node.size() == 3 ? wrap_angle(number(node[2], "start theta", -1e3, 1e3, "rad")) : 0.0};
  }

  YAML::Node load() const {
    std::ifstream file(path_);
    if (!file || std::filesystem::is_directory(path_))
      throw InputError(fmt::format("{}: cannot open the team file", path_.string()));
    try {
      return YAML::Load(file);
    } catch (const YAML::Exception& e) {
      throw InputError(fmt::format("{}:{}: {}", path_.string(), e.mark.line + 1, e.msg));
    }
  }

 private:
  std::filesystem::path path_;
};

RobotSpec read_robot(const Reader& reader, const YAML::Node& node, std::size_t index) {
  if (!node.IsMap()) reader.fail(node, "expected a robot as {name, start, speed, range, fov, beams, radius}");
  reader.known_keys(node, kRobotKeys);
  RobotSpec robot;
  robot.name = node["name"] ? reader.text(node["name"], "name") : fmt::format("robot{}", index + 1);
  constexpr std::string_view kAllowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
  if (robot.name.empty() || robot.name.find_first_not_of(kAllowed) != std::string::npos)
    reader.fail(node["name"], fmt::format("name: expected letters, digits, '_' or '-', not '{}'", robot.name));
  if (node["start"]) robot.start = reader.pose(node["start"]);
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
  const Reader reader(path);
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
