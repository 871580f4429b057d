#include "sim/simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>

#include "sim/checks.hpp"
#include "sim/simulated_body.hpp"
#include "world/error.hpp"
#include "world/ray.hpp"

namespace outrider::sim {
namespace {

constexpr double kRounding = 1e-12;  ///< a way this short is rounding [m]
constexpr double kCorner = 1e-9;     ///< a cell is not entered by touching its corner: shortest way in it [m]
constexpr double kSameTime = 1e-9;   ///< [s]

std::string describe(const SimulatedBody& body) {
  return fmt::format("robot '{}' at ({:.9g}, {:.9g}) with radius {:.9g} m", body.spec.name, body.pose.x, body.pose.y,
                     body.spec.radius);
}

/// distance(a, b) <= r, at little cost for points far apart.
bool within(Point a, Point b, double r) {
  return std::abs(a.x - b.x) <= r && std::abs(a.y - b.y) <= r && distance(a, b) <= r;
}

/// A robot's own stream: the seeds of neighbouring robots and of neighbouring runs must not be alike (splitmix64).
std::uint64_t stream_seed(std::uint64_t seed, std::uint64_t robot) {
  std::uint64_t z = seed * 0x9E3779B97F4A7C15U + (robot + 1) * 0xD1B54A32D192ED03U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  return z ^ (z >> 31U);
}

}  // namespace

struct Simulator::Impl {
  Impl(const OccupancyGrid& map, std::vector<RobotSpec> robots, const SimOptions& sim_options);
  void add_body(std::size_t id);

  void advance(SimulatedBody& body, double way);
  std::vector<const SimulatedBody*> bodies_near(const SimulatedBody& body, double way) const;
  void sense_cells(SimulatedBody& body, const Sweep& way, double length) const;
  void sense_from(SimulatedBody& body, Cell cell) const;
  void take_scans();
  std::vector<Sighting> in_view_of(const SimulatedBody& body) const;
  std::optional<std::string> violation() const;

  SimOptions options;
  OccupancyGrid truth;
  OccupancyGrid solid;  ///< the truth inside a ring of walls
  std::vector<RobotSpec> team;
  std::map<double, Walls> walls;              ///< by radius
  std::map<double, CellSensor> cell_sensors;  ///< by range
  std::vector<std::unique_ptr<SimulatedBody>> bodies;
  double now = 0.0;
  std::uint64_t steps = 0;
  std::uint64_t scans_due = 0;  ///< scans before now, had they been taken at scan_rate exactly
};

Simulator::Impl::Impl(const OccupancyGrid& map, std::vector<RobotSpec> robots, const SimOptions& sim_options)
    : options(sim_options), truth(map), solid(solid_world(map)), team(std::move(robots)) {
  check_options(options);
  for (std::size_t id = 0; id < team.size(); ++id) add_body(id);
  if (const auto problem = violation()) throw InputError("cannot start there: " + *problem);
  if (options.lidar) take_scans();
  for (const auto& body : bodies)
    if (!options.lidar) sense_from(*body, truth.geometry().cell_of(body->pose.position()));
}

void Simulator::Impl::add_body(std::size_t id) {
  const RobotSpec& robot = team[id];
  check_robot(robot, options.lidar);
  const Walls& body_walls = walls.try_emplace(robot.radius, truth, robot.radius).first->second;
  bodies.push_back(std::make_unique<SimulatedBody>(robot, body_walls, [this, id] { return in_view_of(*bodies[id]); }));
  SimulatedBody& body = *bodies.back();
  if (options.lidar) {
    body.lidar.emplace(robot, options.range_noise, stream_seed(options.seed, id));
  } else {
    body.cell_sensor = &cell_sensors.try_emplace(robot.range, truth, robot.range).first->second;
    body.seen.assign(truth.size(), false);
  }
}

/// Drives `body` along its path, `way` metres or up to what is in the way.
void Simulator::Impl::advance(SimulatedBody& body, double way) {
  const auto others = bodies_near(body, way);
  while (way > kRounding && !body.blocked) {
    const SimulatedBody::Leg* leg = body.leg();
    if (leg == nullptr) break;
    const Sweep ahead{leg->way.at(leg->driven), leg->way.dx, leg->way.dy};
    const double left = leg->length - leg->driven;
    const double wanted = way < left - kRounding ? way : left;
    double reach = std::clamp(leg->free - leg->driven, 0.0, wanted);
    for (const SimulatedBody* other : others) {
      const double touching = body.spec.radius + other->spec.radius - kStopDepth;
      reach = std::min(reach, entry_into_disc(ahead, other->pose.position(), touching));
    }
    body.blocked = reach < wanted;
    body.drive_to(reach == left ? leg->length : leg->driven + reach);
    way -= reach;
    if (!options.lidar) sense_cells(body, ahead, reach);
  }
  if (!options.lidar) sense_from(body, truth.geometry().cell_of(body.pose.position()));
}

/// The other bodies that `body` could meet within the next `way` metres.
std::vector<const SimulatedBody*> Simulator::Impl::bodies_near(const SimulatedBody& body, double way) const {
  std::vector<const SimulatedBody*> near;
  for (const auto& other : bodies)
    if (other.get() != &body && within(body.pose.position(), other->pose.position(),
                                       way + body.spec.radius + other->spec.radius + kTouchTolerance))
      near.push_back(other.get());
  return near;
}

/// Senses from each cell entered on a straight way.
void Simulator::Impl::sense_cells(SimulatedBody& body, const Sweep& way, double length) const {
  Cell cell = body.sensed_from;
  double entered = length;
  walk_ray(truth.geometry(), way.from, way.dx, way.dy, length, [&](Cell next, double at) {
    if (at - entered > kCorner) sense_from(body, cell);
    cell = next;
    entered = at;
    return true;
  });
  if (length - entered > kCorner) sense_from(body, cell);
}

void Simulator::Impl::sense_from(SimulatedBody& body, Cell cell) const {
  if (cell == body.sensed_from) return;
  body.sensed_from = cell;
  body.cell_sensor->sense(cell, body.seen, body.gathering.cells);
}

void Simulator::Impl::take_scans() {
  for (const auto& body : bodies)
    if (body->alive) body->gathering.scans.push_back({body->pose, body->lidar->scan(solid, body->pose, now)});
  scans_due = static_cast<std::uint64_t>(std::floor((now + kSameTime) * options.scan_rate)) + 1;
}

std::vector<Sighting> Simulator::Impl::in_view_of(const SimulatedBody& body) const {
  std::vector<Sighting> in_view;
  const Point from = body.pose.position();
  for (std::size_t id = 0; id < bodies.size(); ++id) {
    const SimulatedBody& other = *bodies[id];
    const Point to = other.pose.position();
    if (&other == &body || !within(from, to, body.spec.range)) continue;
    const double apart = distance(from, to);
    bool clear = true;
    walk_ray(solid.geometry(), from, (to.x - from.x) / apart, (to.y - from.y) / apart, apart, [&](Cell c, double) {
      clear = solid[c] == CellState::kFree;
      return clear;
    });
    if (clear) in_view.push_back({static_cast<RobotId>(id), to, other.spec.radius});
  }
  return in_view;
}

/// What breaks the rules of the world now, if anything.
std::optional<std::string> Simulator::Impl::violation() const {
  for (const auto& body : bodies) {
    const Point p = body->pose.position();
    if (body->walls.fits(p)) continue;
    const bool inside = truth.contains(truth.geometry().cell_of(p));
    return describe(*body) + (inside ? " is in a wall" : " is off the map");
  }
  for (std::size_t i = 0; i < bodies.size(); ++i)
    for (std::size_t j = i + 1; j < bodies.size(); ++j) {
      const double touching = bodies[i]->spec.radius + bodies[j]->spec.radius - kTouchTolerance;
      const Point a = bodies[i]->pose.position(), b = bodies[j]->pose.position();
      if (within(a, b, touching) && distance(a, b) < touching)
        return describe(*bodies[i]) + " overlaps " + describe(*bodies[j]);
    }
  return std::nullopt;
}

Simulator::Simulator(const OccupancyGrid& truth, std::vector<RobotSpec> team, const SimOptions& options)
    : impl_(std::make_unique<Impl>(truth, std::move(team), options)) {}
Simulator::~Simulator() = default;
Simulator::Simulator(Simulator&&) noexcept = default;
Simulator& Simulator::operator=(Simulator&&) noexcept = default;

void Simulator::step() {
  Impl& sim = *impl_;
  const double dt = sim.options.dt;
  const double scans = sim.options.lidar ? dt * sim.options.scan_rate : 1.0;
  const int parts = std::max(1, static_cast<int>(std::ceil(scans - kSameTime)));
  for (const auto& body : sim.bodies) body->blocked = false;
  for (int part = 1; part <= parts; ++part) {
    for (const auto& body : sim.bodies)
      if (body->alive) sim.advance(*body, body->spec.speed * body->speed_factor * dt / parts);
    sim.now = (static_cast<double>(sim.steps) + static_cast<double>(part) / parts) * dt;
    if (sim.options.lidar && sim.now + kSameTime >= static_cast<double>(sim.scans_due) / sim.options.scan_rate)
      sim.take_scans();
  }
  ++sim.steps;
  if (const auto problem = sim.violation())
    throw std::logic_error(fmt::format("simulator, {:.6f} s: {}", sim.now, *problem));
}

Body& Simulator::body(RobotId robot) { return *impl_->bodies.at(static_cast<std::size_t>(robot)); }
double Simulator::now() const { return impl_->now; }
const Pose2& Simulator::pose(RobotId robot) const { return impl_->bodies.at(static_cast<std::size_t>(robot))->pose; }
double Simulator::path_m(RobotId robot) const { return impl_->bodies.at(static_cast<std::size_t>(robot))->path_m; }
const std::vector<RobotSpec>& Simulator::team() const { return impl_->team; }
bool Simulator::alive(RobotId robot) const { return impl_->bodies.at(static_cast<std::size_t>(robot))->alive; }

void Simulator::set_speed_factor(RobotId robot, double factor) {
  if (!(factor >= 0.0 && std::isfinite(factor)))
    throw InputError(fmt::format("speed factor {}: expected a number, 0 or more", factor));
  impl_->bodies.at(static_cast<std::size_t>(robot))->speed_factor = factor;
}

void Simulator::kill(RobotId robot) {
  SimulatedBody& body = *impl_->bodies.at(static_cast<std::size_t>(robot));
  body.follow({});
  body.alive = false;
}

void Simulator::place(RobotId robot, const Pose2& pose) {
  SimulatedBody& body = *impl_->bodies.at(static_cast<std::size_t>(robot));
  assert(!body.alive);
  body.pose = pose;
}

void Simulator::revive(RobotId robot) { impl_->bodies.at(static_cast<std::size_t>(robot))->alive = true; }

}  // namespace outrider::sim
