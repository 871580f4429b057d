// patrolling_sim's .graph files.

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "explorer/mission_file.hpp"
#include "world/error.hpp"

namespace outrider::explorer {
namespace {

using decision::SemanticState;
using decision::TopologicalMap;
using decision::Waypoint;

constexpr double kFar = 1e6;  // [m], of coordinates

/// Tokens of a .graph file with the line of each.
class GraphTokens {
 public:
  explicit GraphTokens(const std::filesystem::path& path) : path_(path), file_(path) {
    if (!file_ || std::filesystem::is_directory(path))
      throw InputError(fmt::format("{}: cannot open the graph file", path.string()));
  }
  bool next(std::string& token) {
    while (!(line_ >> token)) {
      std::string text;
      if (!std::getline(file_, text)) return false;
      ++number_;
      line_ = std::istringstream(text);
    }
    return true;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", path_.string(), number_, what));
  }
  double number(const std::string& what, double low, double high) {
    std::string token;
    if (!next(token)) fail(fmt::format("the file ends; expected {}", what));
    char* end = nullptr;
    const double value = std::strtod(token.c_str(), &end);
    if (*end != '\0' || !(value >= low && value <= high))
      fail(fmt::format("{}: expected a number from {} to {}, not '{}'", what, low, high, token));
    return value;
  }
  int whole(const std::string& what, int low, int high) {
    const double value = number(what, low, high);
    if (value != std::floor(value)) fail(fmt::format("{}: expected a whole number, not {}", what, value));
    return static_cast<int>(value);
  }

 private:
  std::filesystem::path path_;
  std::ifstream file_;
  std::istringstream line_;
  int number_ = 0;
};

}  // namespace

TopologicalMap read_graph(const std::filesystem::path& path) {
  GraphTokens in(path);
  const int n = in.whole("the number of vertices", 1, 100000);
  in.number("the width [cells]", 0, 1e6);
  in.number("the height [cells]", 0, 1e6);
  const double resolution = in.number("the resolution [m]", 1e-6, 1e3);
  const double x0 = in.number("the x offset [m]", -kFar, kFar), y0 = in.number("the y offset [m]", -kFar, kFar);
  TopologicalMap map;
  map.waypoints.resize(static_cast<std::size_t>(n));
  std::vector<char> seen(static_cast<std::size_t>(n), 0);
  for (int k = 0; k < n; ++k) {
    const int v = in.whole("the id of a vertex", 0, n - 1);
    if (seen[static_cast<std::size_t>(v)]) in.fail(fmt::format("vertex {} twice", v));
    seen[static_cast<std::size_t>(v)] = 1;
    Waypoint& w = map.waypoints[static_cast<std::size_t>(v)];
    w.id = std::to_string(v);
    w.pose.x = x0 + resolution * in.number("x of a vertex [cells]", -1e6, 1e6);
    w.pose.y = y0 + resolution * in.number("y of a vertex [cells]", -1e6, 1e6);
    const int neighbours = in.whole("the number of neighbours", 0, n);
    w.state = neighbours == 1 ? SemanticState::kDeadEnd : neighbours == 2 ? SemanticState::kCorridor
            : neighbours == 3 ? SemanticState::kJunction : SemanticState::kIntersection;
    std::map<int, std::size_t> met;  // published graphs name a neighbour twice; the cheaper edge holds
    for (int j = 0; j < neighbours; ++j) {
      const int to = in.whole(fmt::format("neighbour of vertex {}", v), 0, n - 1);
      if (to == v) in.fail(fmt::format("vertex {} is its own neighbour", v));
      std::string heading;
      if (!in.next(heading)) in.fail("the file ends; expected a direction");
      if (heading.empty() || heading.find_first_not_of("NSEW") != std::string::npos)
        in.fail(fmt::format("direction: expected N, S, E, W or two of them, not '{}'", heading));
      const double cost = in.number("the cost of an edge [cells]", 0, 1e9);
      if (!(cost > 0.0)) in.fail("the cost of an edge: expected a number above 0");
      const auto [edge, fresh] = met.try_emplace(to, map.paths.size());
      if (fresh) map.paths.push_back(decision::certain_path(v, to, cost * resolution));
      else map.paths[edge->second].cost = std::min(map.paths[edge->second].cost, cost * resolution);
    }
  }
  std::string rest;
  if (in.next(rest)) in.fail(fmt::format("expected the end of the file after {} vertices, not '{}'", n, rest));
  return map;
}

}  // namespace outrider::explorer
