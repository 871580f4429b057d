#include "explorer/referee.hpp"

#include <algorithm>
#include <cmath>

#include "decision/distance_field.hpp"
#include "decision/passability.hpp"

namespace outrider::explorer {
namespace {

constexpr std::uint16_t kNever = 65535;
constexpr std::uint16_t kMostSteps = 4000;  // of playback; more halves its rate

/// True when b continues the straight, uniform motion from a to the last pose, so that the last pose adds nothing.
bool uniform(const TimedPose& a, const TimedPose& last, const TimedPose& b) {
  const double s = (last.t - a.t) / (b.t - a.t);
  return std::abs(a.pose.x + s * (b.pose.x - a.pose.x) - last.pose.x) < 1e-9 &&
         std::abs(a.pose.y + s * (b.pose.y - a.pose.y) - last.pose.y) < 1e-9 && a.pose.theta == last.pose.theta &&
         last.pose.theta == b.pose.theta;
}

}  // namespace

OccupancyGrid solid_map(OccupancyGrid map) {
  std::replace(map.data().begin(), map.data().end(), CellState::kUnknown, CellState::kOccupied);
  return map;
}

Grid<std::uint8_t> reachable_area(const OccupancyGrid& truth, const std::vector<RobotSpec>& team) {
  double slimmest = std::numeric_limits<double>::infinity();
  std::vector<Cell> starts;
  for (const RobotSpec& robot : team) {
    slimmest = std::min(slimmest, robot.radius);
    starts.push_back(truth.geometry().cell_of(robot.start.position()));
  }
  const auto mask = decision::passable_mask(truth, slimmest);
  decision::DistanceField field;
  field.compute(mask, starts);
  Grid<std::uint8_t> reachable(truth.geometry());
  const auto& g = truth.geometry();
  const int reach = static_cast<int>(slimmest / g.resolution);
  std::vector<Cell> disc;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x)
      if (std::hypot(x, y) * g.resolution <= slimmest) disc.push_back({x, y});
  const auto reached = [&](int x, int y) { return field.reached({x, y}); };
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Cell c = g.cell_at(i);
    if (!field.reached(c)) continue;
    reachable[i] = truth[i] == CellState::kFree;
    // On the way to a cell beyond, the body's centre leaves the reached cells at one that has another beside it: those
    // sweep all that others sweep.
    if (reached(c.x - 1, c.y) && reached(c.x + 1, c.y) && reached(c.x, c.y - 1) && reached(c.x, c.y + 1)) continue;
    for (const Cell offset : disc) {
      const Cell n{c.x + offset.x, c.y + offset.y};
      if (g.contains(n) && truth[n] == CellState::kFree) reachable[n] = 1;
    }
  }
  return reachable;
}

Referee::Referee(const OccupancyGrid& truth, const std::vector<RobotSpec>& team)
    : truth_(truth), reachable_(reachable_area(truth, team)), known_since_(truth.geometry(), kNever) {
  reachable_cells_ = static_cast<std::size_t>(std::count(reachable_.data().begin(), reachable_.data().end(), 1));
  for (const RobotSpec& spec : team) {
    MissionRobot robot;
    robot.spec = spec;
    robot.seen = BitGrid(truth.geometry());
    robots_.push_back(std::move(robot));
  }
  for (const double fraction : {0.5, 0.9, 0.95, 0.99}) time_to_.emplace_back(fraction, std::nullopt);
}

void Referee::saw(RobotId robot, const std::vector<std::uint32_t>& cells, double now_s) {
  MissionRobot& r = robots_[static_cast<std::size_t>(robot)];
  const auto step = static_cast<std::uint16_t>(std::min<double>(kNever - 1, now_s / playback_step_s_));
  for (const std::uint32_t i : cells) {
    r.seen.insert(i);
    if (known_since_[i] != kNever) continue;
    known_since_[i] = step;
    if (truth_[i] == CellState::kFree) r.first_seen_m2 += truth_.geometry().cell_area();
    seen_reachable_ += reachable_[i];
  }
}

void Referee::stands(RobotId robot, const TimedPose& at) {
  auto& trajectory = robots_[static_cast<std::size_t>(robot)].trajectory;
  const std::size_t n = trajectory.size();
  if (n >= 2 && uniform(trajectory[n - 2], trajectory[n - 1], at)) trajectory.back() = at;
  else trajectory.push_back(at);
}

void Referee::tick(double now_s) {
  for (auto& [fraction, time] : time_to_)
    if (!time && explored_fraction() >= fraction) time = now_s;
  if (now_s + 1e-9 < next_row_s_ && !timeline_.empty()) return;
  TimelinePoint row{now_s, explored_fraction(), 0.0, {}};
  for (const MissionRobot& robot : robots_) {
    row.robot_m2.push_back(robot.first_seen_m2);
    row.explored_m2 += robot.first_seen_m2;
  }
  timeline_.push_back(std::move(row));
  if (now_s / playback_step_s_ > kMostSteps) coarsen_playback();
  next_row_s_ = (std::floor(now_s / playback_step_s_ + 1e-9) + 1.0) * playback_step_s_;
}

/// Halves the rate of playback and timeline, so that a run of any length fits.
void Referee::coarsen_playback() {
  playback_step_s_ *= 2.0;
  for (std::uint16_t& step : known_since_.data())
    if (step != kNever) step = static_cast<std::uint16_t>(step / 2);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < timeline_.size(); k += 2) timeline_[kept++] = std::move(timeline_[k]);
  timeline_.resize(kept);
}

double Referee::explored_fraction() const {
  return reachable_cells_ == 0 ? 1.0
                               : static_cast<double>(seen_reachable_) / static_cast<double>(reachable_cells_);
}

double Referee::patience_s() const {
  double slowest = std::numeric_limits<double>::infinity(), width = 0.0;
  for (const auto& robot : robots_) {
    slowest = std::min(slowest, robot.spec.speed);
    width = std::max(width, robot.spec.radius);
  }
  const double area = static_cast<double>(reachable_cells_) * truth_.geometry().cell_area();
  const double across = truth_.geometry().resolution * (truth_.width() + truth_.height());
  return 10.0 * (area / std::max(truth_.geometry().resolution, 2.0 * width) + across) / slowest;
}

double Referee::expected_s() const {
  double sweep = 0.0, speed = 0.0;
  for (const auto& robot : robots_) {
    sweep += robot.spec.speed * robot.spec.range;
    speed += robot.spec.speed / static_cast<double>(robots_.size());
  }
  const double area = static_cast<double>(reachable_cells_) * truth_.geometry().cell_area();
  return area / sweep + truth_.geometry().resolution * (truth_.width() + truth_.height()) / speed;
}

void Referee::conclude(std::span<const OccupancyGrid* const> maps, MissionResult& result) {
  result.explored_fraction = explored_fraction();
  result.reachable_m2 = static_cast<double>(reachable_cells_) * truth_.geometry().cell_area();
  result.time_to = time_to_;
  result.known_since = std::move(known_since_);
  result.playback_step_s = playback_step_s_;
  result.timeline = std::move(timeline_);
  result.map = OccupancyGrid(truth_.geometry());
  for (const OccupancyGrid* map : maps)  // robots that never met may know different parts: the team knows them all
    for (std::size_t i = 0; i < map->size(); ++i) result.map[i] = std::max(result.map[i], (*map)[i]);
}

}  // namespace outrider::explorer
