#include "explorer/mission_file.hpp"

#include <cmath>
#include <set>

#include "explorer/yaml_reader.hpp"

namespace outrider::explorer {
namespace {

using decision::Outcome;
using decision::Path;
using decision::SemanticState;
using decision::SupervisionRule;
using decision::TopologicalMap;
using decision::TopoMission;
using decision::TopoRobot;
using decision::Waypoint;

constexpr double kFar = 1e6;        // [m], of coordinates
constexpr double kDearest = 1e9;    // of a path
constexpr double kRounding = 1e-6;  // of a sum of probabilities

std::vector<std::string> state_names() {
  std::vector<std::string> names;
  for (int s = 0; s < decision::kSemanticStates; ++s) names.emplace_back(to_string(static_cast<SemanticState>(s)));
  return names;
}

/// Reads one mission file.
class MissionReader {
 public:
  explicit MissionReader(const std::filesystem::path& path) : in_(path, "mission file") {}

  TopoMission read(bool whole) {
    const YAML::Node root = in_.load();
    if (!root.IsMap())
      throw InputError(fmt::format("{}: expected a mission with waypoints, paths, robots and goals", in_.path().string()));
    in_.known_keys(root, {"waypoints", "paths", "graph", "robots", "goals"});
    if (root["graph"]) {
      if (root["waypoints"] || root["paths"]) in_.fail(root["graph"], "graph: stands for waypoints and paths; give one or the other");
      mission_.map = read_graph(in_.path().parent_path() / in_.text(root["graph"], "graph"));
    } else {
      for (const YAML::Node& node : list(root, "waypoints")) waypoint(node);
      if (root["paths"])
        for (const YAML::Node& node : list(root, "paths", true)) path(node);
    }
    if (!whole) return std::move(mission_);
    for (const YAML::Node& node : list(root, "robots")) robot(node);
    for (const YAML::Node& node : list(root, "goals", true)) goal(node);
    std::size_t robot_index = 0;
    for (const YAML::Node& node : root["robots"]) current_goals(node, mission_.robots[robot_index++]);
    return std::move(mission_);
  }

 private:
  YAML::Node list(const YAML::Node& root, const std::string& key, bool may_be_empty = false) const {
    const YAML::Node node = root[key];
    if (!node) throw InputError(fmt::format("{}: {}: missing; expected a list", in_.path().string(), key));
    if (!node.IsSequence()) in_.fail(node, fmt::format("{}: expected a list", key));
    if (!may_be_empty && node.size() == 0) in_.fail(node, fmt::format("{}: expected at least one", key));
    return node;
  }

  YAML::Node required(const YAML::Node& node, const std::string& key) const {
    if (!node[key]) in_.fail(node, fmt::format("{}: missing", key));
    return node[key];
  }

  std::string id(const YAML::Node& node, const std::string& key) const {
    std::string text = in_.text(node, key);
    if (text.empty()) in_.fail(node, fmt::format("{}: expected the id of a waypoint", key));
    return text;
  }

  int index_of(const YAML::Node& node, const std::string& key, const TopologicalMap& map) const {
    const std::string name = id(node, key);
    if (const auto w = map.find(name)) return *w;
    std::vector<std::string> ids;
    for (const Waypoint& w : map.waypoints) ids.push_back(w.id);
    const std::string hint = nearest_names(name, ids).empty() ? "" : suggestion(name, ids);
    in_.fail(node, fmt::format("{}: there is no waypoint '{}'{}", key, name, hint));
  }

  void waypoint(const YAML::Node& node) {
    if (!node.IsMap()) in_.fail(node, "expected a waypoint as {id, x, y, theta, state}");
    in_.known_keys(node, {"id", "x", "y", "theta", "state", "landmark"});
    Waypoint w;
    w.id = id(required(node, "id"), "id");
    if (!ids_.insert(w.id).second) in_.fail(node, fmt::format("id: '{}' is taken; ids must differ", w.id));
    w.pose.x = in_.number(required(node, "x"), "x", -kFar, kFar, "m");
    w.pose.y = in_.number(required(node, "y"), "y", -kFar, kFar, "m");
    if (node["theta"]) w.pose.theta = wrap_angle(in_.number(node["theta"], "theta", -1e3, 1e3, "rad"));
    if (node["landmark"]) w.landmark = static_cast<int>(in_.number(node["landmark"], "landmark", -1, 1e9, ""));
    if (node["state"]) {
      const std::string name = in_.text(node["state"], "state");
      const auto state = decision::semantic_state(name);
      if (!state) in_.fail(node["state"], fmt::format("state: unknown '{}'{}", name, suggestion(name, state_names())));
      w.state = *state;
    }
    mission_.map.waypoints.push_back(std::move(w));
  }

  void path(const YAML::Node& node) {
    if (!node.IsMap()) in_.fail(node, "expected a path as {from, to, cost, deviation}");
    in_.known_keys(node, {"from", "to", "cost", "deviation", "rule", "via", "two_way"});
    TopologicalMap& map = mission_.map;
    Path p;
    p.from = index_of(required(node, "from"), "from", map);
    p.to = index_of(required(node, "to"), "to", map);
    if (p.from == p.to) in_.fail(node, "to: expected another waypoint than from");
    if (node["via"]) {
      if (!node["via"].IsSequence()) in_.fail(node["via"], "via: expected a list of [x, y]");
      for (const YAML::Node& point : node["via"]) p.via.push_back(in_.pose(point, "via").position());
    }
    if (node["rule"]) p.rule = rule(node["rule"]);
    p.cost = node["cost"] ? in_.number(node["cost"], "cost", 0.0, kDearest, "") : length(p);
    if (!(p.cost > 0.0)) in_.fail(node["cost"] ? node["cost"] : node, "cost: expected a number above 0");
    p.outcomes = outcomes(node["deviation"], p.to);
    const bool two_way = node["two_way"] && in_.yes_no(node["two_way"], "two_way");
    add(node, p);
    if (!two_way) return;
    if (node["deviation"]) in_.fail(node["deviation"], "deviation: belongs to one direction; write two paths");
    std::swap(p.from, p.to);
    std::reverse(p.via.begin(), p.via.end());
    p.outcomes = {{p.to, 1.0}};
    p.rule = {};
    add(node, p);
  }

  void add(const YAML::Node& node, const Path& p) {
    if (!pairs_.insert({p.from, p.to}).second)
      in_.fail(node, fmt::format("path from '{}' to '{}' twice", name(p.from), name(p.to)));
    mission_.map.paths.push_back(p);
  }

  const std::string& name(int w) const { return mission_.map.waypoints[static_cast<std::size_t>(w)].id; }

  double length(const Path& p) const {
    Point at = mission_.map.waypoints[static_cast<std::size_t>(p.from)].pose.position();
    double sum = 0.0;
    std::vector<Point> way = p.via;
    way.push_back(mission_.map.waypoints[static_cast<std::size_t>(p.to)].pose.position());
    for (const Point next : way) sum += distance(at, next), at = next;
    return sum;
  }

  SupervisionRule rule(const YAML::Node& node) const {
    const std::string text = in_.text(node, "rule");
    if (text == "reach") return {};
    int exit = -1, end = 0;
    if (std::sscanf(text.c_str(), "exit %d%n", &exit, &end) == 1 && end == static_cast<int>(text.size()) && exit >= 0)
      return {SupervisionRule::Kind::kExit, exit};
    in_.fail(node, fmt::format("rule: expected 'reach' or 'exit K' (K counted from the left, 0 first), not '{}'", text));
  }

  /// d_p: what is not listed goes to the target.
  std::vector<Outcome> outcomes(const YAML::Node& node, int to) const {
    if (!node) return {{to, 1.0}};
    if (!node.IsMap()) in_.fail(node, "deviation: expected a map from waypoint ids to probabilities");
    std::vector<Outcome> result;
    double sum = 0.0;
    bool target_listed = false;
    for (const auto& entry : node) {
      const int w = index_of(entry.first, "deviation", mission_.map);
      const double p = in_.number(entry.second, fmt::format("deviation to '{}'", name(w)), 0.0, 1.0, "");
      for (const Outcome& o : result)
        if (o.waypoint == w) in_.fail(entry.first, fmt::format("deviation: waypoint '{}' twice", name(w)));
      if (p > 0.0) result.push_back({w, p});
      target_listed = target_listed || w == to;
      sum += p;
    }
    if (sum > 1.0 + kRounding || (target_listed && sum < 1.0 - kRounding))
      in_.fail(node, fmt::format("deviation: the probabilities sum to {:g}; expected 1, or less when the target '{}' is "
                                 "not listed and gets the rest", sum, name(to)));
    if (!target_listed && sum < 1.0) result.push_back({to, 1.0 - sum});
    double to_target = 0.0, most = 0.0;
    for (const Outcome& o : result) (o.waypoint == to ? to_target : most) = std::max(o.waypoint == to ? to_target : most, o.probability);
    if (to_target < most || to_target <= kRounding)
      in_.fail(node, fmt::format("deviation: the target '{}' has {:g}; expected the highest probability", name(to), to_target));
    for (Outcome& o : result)
      if (target_listed) o.probability /= sum;
    return result;
  }

  void robot(const YAML::Node& node) {
    if (!node.IsMap()) in_.fail(node, "expected a robot as {name, at}");
    in_.known_keys(node, {"name", "at", "speed", "map", "goals"});
    TopoRobot r;
    r.name = node["name"] ? in_.text(node["name"], "name") : fmt::format("robot{}", mission_.robots.size() + 1);
    constexpr std::string_view kAllowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
    if (r.name.empty() || r.name.find_first_not_of(kAllowed) != std::string::npos)
      in_.fail(node["name"], fmt::format("name: expected letters, digits, '_' or '-', not '{}'", r.name));
    for (const TopoRobot& other : mission_.robots)
      if (other.name == r.name) in_.fail(node, fmt::format("name: '{}' is taken; names must differ", r.name));
    if (node["map"])
      r.own = std::make_shared<TopologicalMap>(read_topological_map(in_.path().parent_path() / in_.text(node["map"], "map")));
    if (node["speed"]) r.speed = in_.number(node["speed"], "speed", 1e-3, 1e3, "");
    r.at = index_of(required(node, "at"), "at", r.own ? *r.own : mission_.map);
    mission_.robots.push_back(std::move(r));
  }

  void goal(const YAML::Node& node) {
    const int w = index_of(node, "goals", mission_.map);
    if (std::find(mission_.goals.begin(), mission_.goals.end(), w) != mission_.goals.end())
      in_.fail(node, fmt::format("goals: '{}' twice", name(w)));
    if (mission_.goals.size() >= 256) in_.fail(node, "goals: expected at most 256");
    mission_.goals.push_back(w);
  }

  /// The goals that a robot has from before.
  void current_goals(const YAML::Node& node, TopoRobot& robot) {
    if (!node["goals"]) return;
    if (!node["goals"].IsSequence()) in_.fail(node["goals"], "goals: expected a list of waypoint ids");
    for (const YAML::Node& entry : node["goals"]) {
      const int w = index_of(entry, "goals", mission_.map);
      const auto at = std::find(mission_.goals.begin(), mission_.goals.end(), w);
      if (at == mission_.goals.end()) in_.fail(entry, fmt::format("goals: '{}' is no goal of the mission", name(w)));
      const auto goal = static_cast<int>(at - mission_.goals.begin());
      if (!owned_.insert(goal).second) in_.fail(entry, fmt::format("goals: '{}' has an owner already", name(w)));
      robot.current.push_back(goal);
    }
  }

  YamlReader in_;
  TopoMission mission_;
  std::set<int> owned_;
  std::set<std::string> ids_;
  std::set<std::pair<int, int>> pairs_;
};

/// Ids are written so that YAML reads back the same text.
std::string quoted(const std::string& id) {
  constexpr std::string_view kPlain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-.";
  if (id.find_first_not_of(kPlain) == std::string::npos) return id;
  std::string text = "\"";
  for (const char c : id) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + '"';
}

}  // namespace

TopoMission read_mission(const std::filesystem::path& path) { return MissionReader(path).read(true); }

TopologicalMap read_topological_map(const std::filesystem::path& path) {
  return path.extension() == ".graph" ? read_graph(path) : MissionReader(path).read(false).map;
}

std::string mission_text(const TopoMission& mission) {
  const auto& w = mission.map.waypoints;
  const auto id = [&](int i) { return quoted(w[static_cast<std::size_t>(i)].id); };
  std::string text = "waypoints:\n";
  for (const Waypoint& p : w) {
    text += fmt::format("  - {{id: {}, x: {}, y: {}, theta: {}, state: {}", quoted(p.id), p.pose.x, p.pose.y, p.pose.theta,
                        to_string(p.state));
    text += p.landmark >= 0 ? fmt::format(", landmark: {}}}\n", p.landmark) : "}\n";
  }
  text += mission.map.paths.empty() ? "paths: []\n" : "paths:\n";
  for (const Path& p : mission.map.paths) {
    text += fmt::format("  - {{from: {}, to: {}, cost: {}", id(p.from), id(p.to), p.cost);
    if (p.rule.kind == SupervisionRule::Kind::kExit) text += fmt::format(", rule: exit {}", p.rule.exit);
    if (!p.via.empty()) {
      text += ", via: [";
      for (std::size_t i = 0; i < p.via.size(); ++i) text += fmt::format("{}[{}, {}]", i ? ", " : "", p.via[i].x, p.via[i].y);
      text += "]";
    }
    if (p.outcomes.size() > 1) {
      text += ", deviation: {";
      for (std::size_t i = 0; i < p.outcomes.size(); ++i)
        text += fmt::format("{}{}: {}", i ? ", " : "", id(p.outcomes[i].waypoint), p.outcomes[i].probability);
      text += "}";
    }
    text += "}\n";
  }
  text += mission.robots.empty() ? "robots: []\n" : "robots:\n";
  for (const TopoRobot& r : mission.robots) {
    text += fmt::format("  - {{name: {}, at: {}", r.name, id(r.at));
    if (r.speed != 1.0) text += fmt::format(", speed: {}", r.speed);
    for (std::size_t k = 0; k < r.current.size(); ++k)
      text += (k ? ", " : ", goals: [") + id(mission.goals[static_cast<std::size_t>(r.current[k])]);
    text += r.current.empty() ? "}\n" : "]}\n";
  }
  text += "goals: [";
  for (std::size_t g = 0; g < mission.goals.size(); ++g) text += (g ? ", " : "") + id(mission.goals[g]);
  return text + "]\n";
}

}  // namespace outrider::explorer
