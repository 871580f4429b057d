#pragma once

#include <span>
#include <vector>

#include "explorer/mission.hpp"

namespace outrider::explorer {

/// Knows the truth and watches: who saw what first, how much of the reachable area is explored, who drove where.
class Referee {
 public:
  static constexpr double kExplored = 0.99;  ///< of the reachable area: nothing worth mentioning is left

  Referee(const OccupancyGrid& truth, const std::vector<RobotSpec>& team);

  void saw(RobotId robot, const std::vector<std::uint32_t>& cells, double now_s);
  void stands(RobotId robot, const TimedPose& at);
  /// Notes the moments at which milestones are passed and, once a playback step, a row of the timeline.
  void tick(double now_s);

  double explored_fraction() const;
  /// A generous limit: ten times what the slowest robot alone would need to sweep everything [s].
  double patience_s() const;
  /// About how long the mission will take [s]: the team sweeps the reachable area in strips one sensing range wide, and
  /// a robot of mean speed drives once along two sides of the map. Random breaks fall into this time.
  double expected_s() const;
  const MissionRobot& robot(RobotId robot) const { return robots_[static_cast<std::size_t>(robot)]; }
  /// Fills the team's parts of the result; `maps` are the robots' own at the end.
  void conclude(std::span<const OccupancyGrid* const> maps, MissionResult& result);

 private:
  void coarsen_playback();

  const OccupancyGrid& truth_;
  Grid<std::uint8_t> reachable_;
  std::size_t reachable_cells_ = 0;
  std::size_t seen_reachable_ = 0;     // cells of reachable_ that somebody saw
  Grid<std::uint16_t> known_since_;
  double playback_step_s_ = 0.5;
  double next_row_s_ = 0.0;
  std::vector<MissionRobot> robots_;
  std::vector<TimelinePoint> timeline_;
  std::vector<std::pair<double, std::optional<double>>> time_to_;
};

}  // namespace outrider::explorer
