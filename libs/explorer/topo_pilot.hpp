#pragma once
// The supervision part of Lozenguez et al. 2015, section 3.4: one robot carries out its policy on the topological map,
// with the controllers of section 3.2, an odometer that drifts and a detector of landmarks.

#include <optional>
#include <vector>

#include "decision/controllers.hpp"
#include "decision/goal_planner.hpp"
#include "world/body.hpp"

namespace outrider::explorer {

/// A landmark in sight: which waypoint it marks and where, as measured.
struct LandmarkSighting {
  int waypoint = 0;
  Pose2 T_robot_waypoint;
};

/// What came in since the last call. Nothing of it is in the map frame.
struct PilotSensing {
  Pose2 T_last_robot;                       ///< odometer
  LaserScan scan;
  std::vector<LandmarkSighting> landmarks;  ///< nearest first
  std::vector<Point> team_mates;            ///< robot frame [m]
  bool blocked = false;
};

struct PilotSettings {
  decision::LocalInterpreter interpret;
  decision::ReachingController reach;
  double arrive_m = 0.3;     ///< that near to a waypoint is there [m]
  double step_m = 0.4;       ///< how far one command goes [m]
  double patience_s = 8.0;   ///< without getting on, the robot makes for a waypoint in sight and plans anew from there
};

enum class PilotMode { kReaching, kTopological, kWaiting, kDone };
std::string_view to_string(PilotMode mode);

/// One robot's mind. Its pose is an estimate that landmarks set right.
class TopoPilot {
 public:
  /// `planner` gives the policy over `map` (the same); both must outlive this. `at`: the waypoint where it stands, looking
  /// along `theta` [rad].
  TopoPilot(const decision::TopologicalMap& map, decision::GoalPlanner& planner, int at, double theta,
            const PilotSettings& settings);

  /// Goals to visit from now on, as numbers of the planner.
  void set_goals(const TaskSet& goals);
  const TaskSet& goals() const { return goals_; }
  /// One control step: where to drive next, in the robot frame; nothing: stand still.
  std::optional<Point> step(const PilotSensing& sensing, double now_s);

  bool done() const { return mode_ == PilotMode::kDone; }
  PilotMode mode() const { return mode_; }
  decision::SemanticState state() const { return state_; }
  const Pose2& pose() const { return pose_; }  ///< T_map_robot, as it believes
  int at() const { return at_; }               ///< last recognised waypoint
  int heading_for() const;                     ///< the next waypoint, or at()
  std::optional<int> reached() const { return reached_; }  ///< goal reached in the last step
  int lost() const { return lost_; }           ///< how often it had to plan anew

 private:
  void recognise(const PilotSensing& sensing, double now_s);
  void arrive(int waypoint, double now_s);
  void plan(double now_s);
  void get_lost(const PilotSensing& sensing, double now_s);
  std::optional<double> steer(const PilotSensing& sensing);
  Point target() const;
  bool passed(const decision::Path& path) const;

  const decision::TopologicalMap& map_;
  decision::GoalPlanner& planner_;
  PilotSettings settings_;
  std::vector<std::vector<int>> outgoing_;
  TaskSet goals_;
  Pose2 pose_;
  int at_;
  int path_ = -1;             // index of the path being driven
  std::size_t via_ = 0;       // next bend of it
  bool leaving_ = false;      // still at its beginning, on the way through the exit
  PilotMode mode_ = PilotMode::kWaiting;
  decision::SemanticState state_ = decision::SemanticState::kFreeSpace;
  std::optional<int> reached_;
  std::optional<double> last_heading_;  // map frame, as believed
  double best_rest_ = 0.0, progress_s_ = 0.0;
  std::optional<int> refuge_; // a waypoint to find the way again from
  int lost_ = 0;
};

}  // namespace outrider::explorer
