#pragma once
// Two robots close to each other (Matignon, Jeanpierre and Mouaddib 2012, "Local coordination"): a multi-agent Markov
// decision process over the few ways in which they can stand to each other, solved before the mission.

#include <array>

#include "decision/mdp.hpp"
#include "world/geometry.hpp"

namespace outrider::decision {

enum class LocalAction { kGo, kWait, kBack };

/// How two robots stand to each other, as one of them sees it.
enum class Encounter { kFollowing, kFollowed, kFaceToFace, kDiverging };

/// The encounter of a robot at `self` that drives along `heading` (of any length) with one at `other`. Who drives within 60 degrees of the other one's direction drives towards it.
Encounter encounter(Point self, Point heading, Point other, Point other_heading);

/// Distances between centres [m].
struct LocalThresholds {
  double close = 1.0;      ///< below: the joint policy is followed; 0: never
  double emergency = 0.6;  ///< below: one of them backtracks
};

/// What the joint process is made of. Time is in steps in which a robot covers one of the process's two gaps (close to
/// clear, emergency to close).
struct LocalModel {
  double discount = 0.95;
  double near_cost = 0.5;       ///< a step within the close distance
  double first_delay = 2.0;     ///< a step in which the robot that goes first does not
  double second_delay = 1.0;    ///< and in which the other does not; driving back counts three times: it is
                                ///< also driven again
  double contact_cost = 50.0;   ///< they touch
  double pass_standing = 0.5;   ///< a robot finds room to pass one that stands
  double pass_backing = 0.8;    ///< a robot passes one that goes out of its way
};

/// The joint policy for two robots of which one goes first. Nobody waits for somebody that waits for it.
class LocalCoordination {
 public:
  explicit LocalCoordination(const LocalModel& model = {});

  /// What a robot does. `emergency`: closer than that; `first`: whether it is the one that goes first.
  LocalAction action(Encounter encounter, bool emergency, bool first) const;

 private:
  std::array<std::array<LocalAction, 2>, 8> policy_;  // by joint state, of the first and of the second
};

/// The process itself: states are joint states (who leads, face to face, diverging; emergency or close) and "clear",
/// actions are pairs of LocalAction, the first one's times three plus the second one's.
GraphMdp local_mdp(const LocalModel& model);

}  // namespace outrider::decision
