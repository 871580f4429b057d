#pragma once
// Internal to the room: the state of one robot of the Simulator.

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "sim/lidar.hpp"
#include "sim/visibility.hpp"
#include "sim/walls.hpp"
#include "world/body.hpp"

namespace outrider::sim {

class SimulatedBody final : public Body {
 public:
  /// `sightings` lists the team-mates in view now. The references outlive the body.
  SimulatedBody(const RobotSpec& robot, const Walls& body_walls, std::function<std::vector<Sighting>()> sightings)
      : spec(robot), walls(body_walls), pose(robot.start), sightings_in_view_(std::move(sightings)) {}

  const Sensing& sense() override;
  void follow(std::span<const Point> way_points) override;

  /// The straight leg being driven: begun lazily, when the body first moves on it.
  struct Leg {
    Sweep way;
    double length = 0.0;  ///< [m]
    double free = 0.0;    ///< up to where no wall is in the way [m]
    double driven = 0.0;  ///< [m]
  };
  /// The current leg, begun if need be (which turns the body); nullptr at the end of the path.
  Leg* leg();
  /// Drives on along the current leg, up to `driven` [m] from its beginning.
  void drive_to(double driven);
  bool arrived() const { return next_ == way_points_.size(); }

  const RobotSpec& spec;
  const Walls& walls;
  const CellSensor* cell_sensor = nullptr;  ///< cell sensing
  std::vector<bool> seen;                   ///< of each cell, cell sensing
  Cell sensed_from{-1, -1};                 ///< last cell sensed from
  std::optional<Lidar> lidar;               ///< lidar sensing
  Pose2 pose;
  double speed_factor = 1.0;
  double path_m = 0.0;
  bool alive = true;
  bool blocked = false;
  Sensing gathering;  ///< since the last call of sense()

 private:
  std::function<std::vector<Sighting>()> sightings_in_view_;
  std::vector<Point> way_points_;
  std::size_t next_ = 0;
  std::optional<Leg> leg_;
  Sensing delivered_;
};

}  // namespace outrider::sim
