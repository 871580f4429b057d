#pragma once
// A mission carried out in the lidar simulator: perception, control and supervision of Lozenguez et al. 2015, section 3,
// robot by robot, with drifting odometers; robots that meet re-open the auction.

#include <functional>
#include <string>
#include <vector>

#include "explorer/allocation_run.hpp"
#include "explorer/topo_pilot.hpp"
#include "world/grid.hpp"
#include "world/robot.hpp"

namespace outrider::explorer {

struct ExecutionSettings {
  RobotSpec robot;                    ///< of every robot; name and start come from the mission
  AllocationSettings allocation;      ///< protocol at the beginning; dssa with initial `current` at rendezvous
  PilotSettings pilot;
  double scale_drift = 0.03;          ///< each odometer's own scale error, standard deviation
  double turn_drift = 0.03;           ///< heading error of an odometer per root metre, standard deviation [rad]
  double landmark_m = 2.5;            ///< landmarks are detected that near, in line of sight [m]
  double landmark_noise_m = 0.05;     ///< standard deviation, each axis [m]
  double landmark_noise_rad = 0.03;   ///< [rad]
  double rendezvous_m = 5.0;          ///< robots nearer than this, in line of sight, meet; 0: never
  double rendezvous_pause_s = 20.0;   ///< between two meetings of the same robots [s]
  double control_s = 0.2;             ///< period of control and scans [s]
  double most_s = 0.0;                ///< time limit; 0: ten times the allocation's duration, and two minutes [s]
  std::uint64_t seed = 1;
};

struct ExecutionEvent {
  double t = 0.0;
  std::string what;            ///< "waypoint", "goal", "rendezvous", "lost", "done"
  std::vector<int> robots;
  int waypoint = -1;
  int moved = 0;               ///< goals that changed hands at a rendezvous
};

struct ExecutedRobot {
  std::vector<TimedPose> trajectory;  ///< true
  std::vector<TimedPose> believed;
  std::vector<int> reached;           ///< goals in the order of arrival
  double path_m = 0.0;
  double worst_drift_m = 0.0;         ///< between belief and truth
  double topological_share = 0.0;     ///< of the time under topological control
  int lost = 0;
  bool done = false;
};

struct ExecutionResult {
  AllocationResult allocation;        ///< at the beginning
  std::vector<ExecutedRobot> robots;
  std::vector<ExecutionEvent> events;
  std::vector<int> missed;            ///< goals that nobody truly reached
  double time_s = 0.0;                ///< until all were done
  double worst_arrival_m = 0.0;       ///< true distance to a goal when its robot said it was there
  int rendezvous = 0, handed_over = 0;
  bool interrupted = false;
};

/// Runs the mission on the true map `truth`. `going(now_s)` false: stop. Deterministic. Throws InputError for impossible
/// starts and for robots with maps of their own.
ExecutionResult execute(const OccupancyGrid& truth, const decision::TopoMission& mission, const ExecutionSettings& settings,
                        const std::function<bool(double now_s)>& going = {});

}  // namespace outrider::explorer
