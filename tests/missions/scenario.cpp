#include "missions/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "decision/distance_field.hpp"
#include "decision/passability.hpp"
#include "explorer/scan_mapper.hpp"
#include "link/radio.hpp"

namespace outrider::test {
namespace {

using namespace explorer;

constexpr double kCell = 0.5;  // [m]; no robot is wider than a passage of one cell, and no frontier too small for one

/// Numbers drawn one after the other.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed * 0x9E3779B97F4A7C15U + 1) {}
  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint64_t>(n)); }
  bool chance(int percent) { return below(100) < percent; }
  double between(double low, double high) { return low + (high - low) * static_cast<double>(random_() >> 11U) * 0x1p-53; }

 private:
  std::mt19937_64 random_;
};

/// An open space with blocks of all sizes.
void draw_clutter(OccupancyGrid& map, Draw& draw) {
  const int blocks = draw.below(map.width() * map.height() / 12);
  for (int k = 0; k < blocks; ++k) {
    const int x0 = 1 + draw.below(map.width() - 2), y0 = 1 + draw.below(map.height() - 2);
    const int x1 = std::min(map.width() - 1, x0 + 1 + draw.below(3)), y1 = std::min(map.height() - 1, y0 + 1 + draw.below(3));
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) map[Cell{x, y}] = CellState::kOccupied;
  }
}

/// Rooms between walls that cross the whole map, with one or two doors of one cell in each piece of wall.
void draw_rooms(OccupancyGrid& map, Draw& draw) {
  std::vector<int> xs{0}, ys{0};
  while (xs.back() < map.width() - 1) xs.push_back(std::min(map.width() - 1, xs.back() + 3 + draw.below(5)));
  while (ys.back() < map.height() - 1) ys.push_back(std::min(map.height() - 1, ys.back() + 3 + draw.below(4)));
  for (const int x : xs)
    for (int y = 0; y < map.height(); ++y) map[Cell{x, y}] = CellState::kOccupied;
  for (const int y : ys)
    for (int x = 0; x < map.width(); ++x) map[Cell{x, y}] = CellState::kOccupied;
  const auto inside = [&](int a, int b) { return b - a < 2 ? b : a + 1 + draw.below(b - a - 1); };
  for (std::size_t i = 1; i + 1 < xs.size(); ++i)
    for (std::size_t j = 0; j + 1 < ys.size(); ++j)
      if (draw.chance(80)) map[Cell{xs[i], inside(ys[j], ys[j + 1])}] = CellState::kFree;
  for (std::size_t j = 1; j + 1 < ys.size(); ++j)
    for (std::size_t i = 0; i + 1 < xs.size(); ++i)
      if (draw.chance(80)) map[Cell{inside(xs[i], xs[i + 1]), ys[j]}] = CellState::kFree;
}

/// Corridors of one cell in a tree, with some walls opened.
void draw_maze(OccupancyGrid& map, Draw& draw) {
  std::fill(map.data().begin(), map.data().end(), CellState::kOccupied);
  std::vector<Cell> stack{{1, 1}};
  map[Cell{1, 1}] = CellState::kFree;
  while (!stack.empty()) {
    const Cell at = stack.back();
    std::vector<Cell> ways;
    for (const Cell d : {Cell{1, 0}, Cell{-1, 0}, Cell{0, 1}, Cell{0, -1}}) {
      const Cell next{at.x + 2 * d.x, at.y + 2 * d.y};
      if (next.x > 0 && next.y > 0 && next.x < map.width() - 1 && next.y < map.height() - 1 &&
          map[next] == CellState::kOccupied)
        ways.push_back(d);
    }
    if (ways.empty()) {
      stack.pop_back();
      continue;
    }
    const Cell d = ways[static_cast<std::size_t>(draw.below(static_cast<int>(ways.size())))];
    for (int k = 1; k <= 2; ++k) map[Cell{at.x + k * d.x, at.y + k * d.y}] = CellState::kFree;
    stack.push_back({at.x + 2 * d.x, at.y + 2 * d.y});
  }
  for (int k = draw.below(8); k > 0; --k)
    map[Cell{1 + draw.below(map.width() - 2), 1 + draw.below(map.height() - 2)}] = CellState::kFree;
}

OccupancyGrid draw_world(Draw& draw, std::string& text) {
  OccupancyGrid map(GridGeometry{kCell, {-2.0, 1.0}, 7 + draw.below(14), 7 + draw.below(9)}, CellState::kFree);
  const int kind = draw.below(3);
  text = fmt::format("{} x {} {}", map.width(), map.height(), kind == 0 ? "clutter" : kind == 1 ? "rooms" : "maze");
  (kind == 0 ? draw_clutter : kind == 1 ? draw_rooms : draw_maze)(map, draw);
  for (int y = 0; y < map.height(); ++y)
    for (int x = 0; x < map.width(); ++x)
      if (x == 0 || y == 0 || x + 1 == map.width() || y + 1 == map.height()) map[Cell{x, y}] = CellState::kOccupied;
  return map;
}

/// Robots on different cells on which the widest one may stand; fewer where there is no room.
std::vector<RobotSpec> draw_team(const OccupancyGrid& truth, Draw& draw) {
  const bool alike = draw.chance(50);
  const double radius = draw.between(0.1, 0.24);
  const auto mask = decision::passable_mask(truth, 0.24);
  std::vector<Cell> cells;
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) cells.push_back(mask.geometry().cell_at(i));
  std::vector<RobotSpec> team;
  for (int n = 1 + draw.below(5); n > 0 && !cells.empty(); --n) {
    const auto k = draw.below(static_cast<int>(cells.size()));
    const Point at = truth.geometry().center(cells[static_cast<std::size_t>(k)]);
    cells.erase(cells.begin() + k);
    team.push_back({.name = fmt::format("r{}", team.size() + 1), .start = {at.x, at.y, 0.0},
                    .speed = alike ? 0.5 : draw.between(0.3, 1.0), .range = alike ? 2.0 : draw.between(0.8, 4.0),
                    .radius = alike ? radius : draw.between(0.1, 0.24)});
  }
  return team;
}

link::RadioSpec draw_radio(Draw& draw, const std::vector<RobotSpec>& team, std::string& text) {
  link::RadioSpec radio;
  radio.seed = static_cast<std::uint64_t>(draw.below(1000000));
  text += "; radio";
  if (draw.chance(15)) radio.none = true, text += " none";
  if (draw.chance(20)) radio.range_m = draw.between(0.5, 6.0), text += fmt::format(" range {:.1f}", *radio.range_m);
  if (draw.chance(15)) radio.line_of_sight = true, text += " los";
  if (draw.chance(30)) radio.loss = draw.between(0.0, 0.9), text += fmt::format(" loss {:.2f}", radio.loss);
  if (draw.chance(30)) radio.delay_s = draw.between(0.0, 1.5), text += fmt::format(" delay {:.2f}", radio.delay_s);
  if (draw.chance(30)) {
    radio.random_breaks = {{1 + draw.below(5), draw.between(1.0, 15.0), 0.0}};
    text += fmt::format(" breaks {}x{:.1f}", radio.random_breaks[0].count, radio.random_breaks[0].seconds);
  }
  if (draw.chance(20)) {
    const double begin = draw.between(0.0, 30.0);
    radio.breaks = {{draw.chance(50) ? link::Break::Kind::kSplit : link::Break::Kind::kSilence, begin,
                     begin + draw.between(1.0, 40.0), {draw.below(static_cast<int>(team.size()))}}};
    text += fmt::format(" break {:.1f}-{:.1f}", begin, radio.breaks[0].end_s);
  }
  return radio;
}

std::vector<Fault> draw_faults(Draw& draw, const std::vector<RobotSpec>& team, std::string& text) {
  std::vector<Fault> faults;
  for (int k = draw.chance(50) ? 0 : 1 + draw.below(2); k > 0; --k) {
    const RobotId robot = draw.below(static_cast<int>(team.size()));
    const double t = draw.between(0.0, 40.0), later = t + draw.between(0.5, 30.0);
    const int kind = draw.below(4);
    if (kind == 0) {
      faults.push_back({Fault::Kind::kKill, robot, t, 1.0});
      text += fmt::format("; kill {}@{:.1f}", robot, t);
    } else if (kind == 1) {
      faults.push_back({Fault::Kind::kKill, robot, t, 1.0});
      faults.push_back({Fault::Kind::kRevive, robot, later, 1.0});
      text += fmt::format("; kill {}@{:.1f}-{:.1f}", robot, t, later);
    } else if (kind == 2) {
      faults.push_back({Fault::Kind::kSlow, robot, t, draw.between(0.3, 1.5)});
      text += fmt::format("; slow {}@{:.1f}:{:.2f}", robot, t, faults.back().factor);
    } else {
      faults.push_back({Fault::Kind::kDeaf, robot, t, 1.0});
      faults.push_back({Fault::Kind::kHear, robot, later, 1.0});
      text += fmt::format("; deaf {}@{:.1f}-{:.1f}", robot, t, later);
    }
  }
  std::stable_sort(faults.begin(), faults.end(), [](const Fault& a, const Fault& b) { return a.t < b.t; });
  return faults;
}

/// Who lives at the end.
std::vector<bool> living(const Scenario& s, double end_s) {
  std::vector<bool> alive(s.team.size(), true);
  for (const Fault& fault : s.settings.faults) {
    if (fault.t > end_s) continue;
    if (fault.kind == Fault::Kind::kKill) alive[static_cast<std::size_t>(fault.robot)] = false;
    if (fault.kind == Fault::Kind::kRevive) alive[static_cast<std::size_t>(fault.robot)] = true;
  }
  return alive;
}

Point end_of(const MissionRobot& robot) { return robot.trajectory.back().pose.position(); }

/// Cells that a robot can reach from where it is, in truth, around the bodies of the dead.
decision::DistanceField reach_of(const Scenario& s, const MissionResult& result, std::size_t robot,
                                 const std::vector<bool>& alive) {
  const auto& g = s.truth.geometry();
  auto mask = decision::passable_mask(s.truth, s.team[robot].radius);
  for (std::size_t r = 0; r < s.team.size(); ++r)
    for (std::size_t i = 0; i < mask.size() && !alive[r]; ++i)
      if (distance(g.center(g.cell_at(i)), end_of(result.robots[r])) < s.team[r].radius + s.team[robot].radius + kCell)
        mask[i] = 0;
  const Cell at[] = {g.cell_of(end_of(result.robots[robot]))};
  mask[at[0]] = 1;
  decision::DistanceField field;
  field.compute(mask, at);
  return field;
}

void check_robot(const Scenario& s, const MissionResult& result, std::size_t r, const std::vector<bool>& alive,
                 std::vector<Problem>& problems) {
  const auto& g = s.truth.geometry();
  const auto reach = reach_of(s, result, r, alive);
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < s.truth.size(); ++i)
    unknown += reach.reached(g.cell_at(i)) && result.robots[r].map[i] == CellState::kUnknown;
  if (unknown > 0) problems.push_back({fmt::format("{} can reach {} cells that it does not know", s.team[r].name, unknown)});
  const Cell home = g.cell_of(s.team[r].start.position());
  if (s.settings.explorer.return_home && reach.reached(home) && g.cell_of(end_of(result.robots[r])) != home)
    problems.push_back({fmt::format("{} can reach its home and is not there", s.team[r].name)});
}

bool equal(const MissionResult& a, const MissionResult& b) {
  bool same = a.status == b.status && a.time_s == b.time_s && a.mission_time_s == b.mission_time_s && a.map == b.map &&
              a.known_since == b.known_since && a.events.size() == b.events.size() && a.radio.sent == b.radio.sent &&
              a.radio.delivered == b.radio.delivered && a.interaction_s == b.interaction_s;
  for (std::size_t r = 0; same && r < a.robots.size(); ++r)
    same = a.robots[r].trajectory == b.robots[r].trajectory && a.robots[r].map == b.robots[r].map;
  return same;
}

}  // namespace

Scenario draw_scenario(std::uint64_t number) {
  Draw draw(number);
  Scenario s;
  do s.truth = draw_world(draw, s.text);
  while ((s.team = draw_team(s.truth, draw)).empty());
  const auto& table = coordinators();
  s.settings.coordinator = table[static_cast<std::size_t>(draw.below(static_cast<int>(table.size())))].name;
  s.settings.explorer.return_home = draw.chance(50);
  s.settings.sim.lidar = draw.chance(4);
  s.settings.make_mapper = make_scan_mapper;
  s.settings.sim.seed = number;
  s.text += fmt::format("; {} robots, {}{}{}", s.team.size(), s.settings.coordinator,
                        s.settings.explorer.return_home ? ", home" : "", s.settings.sim.lidar ? ", lidar" : "");
  s.settings.radio = draw_radio(draw, s.team, s.text);
  s.settings.faults = draw_faults(draw, s.team, s.text);
  return s;
}

std::vector<Problem> check_scenario(const Scenario& s) {
  std::vector<Problem> problems;
  try {
    const MissionResult result = run_mission(s.truth, s.team, s.settings);
    if (!equal(result, run_mission(s.truth, s.team, s.settings))) problems.push_back({"two runs differ", true});
    if (result.status == MissionStatus::kTimeout) {
      problems.push_back({fmt::format("not finished after {:.0f} s", result.mission_time_s)});
      return problems;
    }
    const auto alive = living(s, result.mission_time_s);
    for (std::size_t r = 0; r < s.team.size(); ++r)
      if (alive[r]) check_robot(s, result, r, alive, problems);
  } catch (const std::exception& e) {  // a collision is one
    problems.push_back({e.what(), true});
  }
  return problems;
}

std::string picture(const Scenario& s, const MissionResult& result) {
  const auto& g = s.truth.geometry();
  const auto alive = living(s, result.mission_time_s);
  std::string text;
  for (int y = g.height - 1; y >= 0; --y) {
    for (int x = 0; x < g.width; ++x) {
      char mark = s.truth[Cell{x, y}] == CellState::kFree ? '.' : '#';
      for (std::size_t r = 0; r < s.team.size(); ++r) {
        if (mark == '.' && alive[r] && result.robots[r].map[Cell{x, y}] != CellState::kFree)
          mark = result.robots[r].map[Cell{x, y}] == CellState::kUnknown ? '?' : 'x';
        if (g.cell_of(s.team[r].start.position()) == Cell{x, y}) mark = static_cast<char>('a' + r);
      }
      for (std::size_t r = 0; r < s.team.size(); ++r)
        if (g.cell_of(end_of(result.robots[r])) == Cell{x, y}) mark = static_cast<char>('A' + r);
      text += mark;
    }
    text += '\n';
  }
  return text;
}

}  // namespace outrider::test
