#include "specs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <sstream>

#include "world/error.hpp"
#include "world/nearest_name.hpp"

namespace outrider::app {
std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream stream(text);
  for (std::string part; std::getline(stream, part, at);) parts.push_back(part);
  return parts;
}

RobotId robot_called(const std::string& name, const std::string& where, const std::vector<RobotSpec>& team) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < team.size(); ++i) {
    if (team[i].name == name) return static_cast<RobotId>(i);
    names.push_back(team[i].name);
  }
  throw InputError(fmt::format("{}: no robot '{}'{}", where, name, suggestion(name, names)));
}

namespace {

using explorer::Fault;

double number(const std::string& text, const std::string& piece, const char* what, double low) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= low && value < 1e9))
    throw InputError(fmt::format("--fault {}: '{}' is no {}", piece, text, what));
  return value;
}

/// One fault, or the two ends of one.
std::vector<Fault> parse_fault(const std::string& piece, const std::vector<RobotSpec>& team) {
  static const std::vector<std::string> kinds{"kill", "revive", "slow", "deaf"};
  const std::string kind = piece.substr(0, piece.find(':'));
  if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw InputError(fmt::format("--fault {}: unknown fault '{}'{}", piece, kind, suggestion(kind, kinds)));
  const bool slow = kind == "slow", deaf = kind == "deaf";
  const auto parts = split(piece, ':');
  const auto where = parts.size() > 1 ? split(parts[1], '@') : std::vector<std::string>{};
  if (where.size() != 2 || parts.size() != (slow ? 3U : 2U))
    throw InputError(fmt::format("--fault {}: expected {}:ROBOT@{}{}", piece, kind, deaf ? "T0-T1" : "T", slow ? ":FACTOR" : ""));
  Fault fault;
  fault.kind = kind == "kill" ? Fault::Kind::kKill : slow ? Fault::Kind::kSlow : deaf ? Fault::Kind::kDeaf : Fault::Kind::kRevive;
  fault.robot = robot_called(where[0], "--fault " + piece, team);
  if (deaf) {
    const auto times = split(where[1], '-');
    if (times.size() != 2) throw InputError(fmt::format("--fault {}: expected deaf:ROBOT@T0-T1", piece));
    fault.t = number(times[0], piece, "time in seconds", 0.0);
    return {fault, {Fault::Kind::kHear, fault.robot, number(times[1], piece, "later time in seconds", fault.t)}};
  }
  fault.t = number(where[1], piece, "time in seconds", 0.0);
  if (slow) fault.factor = number(parts[2], piece, "factor of at least 0", 0.0);
  return {fault};
}

}  // namespace

std::vector<Fault> parse_faults(const std::string& spec, const std::vector<RobotSpec>& team) {
  std::vector<Fault> faults;
  for (const std::string& piece : split(spec, ','))
    for (const Fault& fault : parse_fault(piece, team)) faults.push_back(fault);
  std::stable_sort(faults.begin(), faults.end(), [](const Fault& a, const Fault& b) { return a.t < b.t; });
  return faults;
}

}  // namespace outrider::app
