#pragma once
// The radio of the simulator: who can hear whom, when, and after what delay. Deterministic per seed.

#include <cstdint>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include "world/grid.hpp"
#include "world/robot.hpp"

namespace outrider::link {

/// A time in which some links are cut.
struct Break {
  enum class Kind {
    kSilence,  ///< the named robots (nobody named: everybody) neither speak nor hear
    kSplit,    ///< the named robots hear only each other, and so do the others
  };
  Kind kind = Kind::kSilence;
  double begin_s = 0.0;         ///< [s]
  double end_s = 0.0;           ///< [s], the first moment after it
  std::vector<RobotId> robots;  ///< ascending

  bool cuts(RobotId from, RobotId to, double t) const;
};

/// `count` breaks of the whole team, `seconds` long each, at random times.
struct RandomBreaks {
  int count = 0;
  double seconds = 0.0;
  double within_s = 0.0;  ///< they end by then; 0: within the expected duration of the mission
};

struct RadioSpec {
  bool none = false;                       ///< nobody ever hears anybody
  std::optional<double> range_m;           ///< longer links are cut [m]
  bool line_of_sight = false;              ///< links through occupied cells are cut
  double loss = 0.0;                       ///< probability that one copy of a message is lost
  double delay_s = 0.0;                    ///< from sending to arrival [s]
  std::vector<Break> breaks;
  std::vector<RandomBreaks> random_breaks;
  std::uint64_t seed = 1;
};

/// All breaks of a run, by begin. Random ones do not overlap each other: every placement within the horizon is equally
/// likely. `horizon_s` is the expected duration; it is stretched to twice the sum of the breaks where that is longer.
std::vector<Break> schedule(const RadioSpec& spec, double horizon_s);

/// Decides the fate of every copy of a message. A copy is lost when its link is cut at the time of sending or at the
/// time of arrival: what was said during a break is not heard later. Not thread-safe.
class Radio {
 public:
  using Where = std::function<Point(RobotId)>;  ///< the robot's true position, now
  /// `truth` must outlive the radio.
  Radio(const RadioSpec& spec, double horizon_s, const OccupancyGrid& truth, Where where);

  /// The delay [s], or nothing when `to` will not hear it. Draws a random number only when the spec has losses.
  std::optional<double> operator()(RobotId from, RobotId to, double now_s);
  /// A deaf robot speaks and hears nothing.
  void set_deaf(RobotId robot, bool deaf);

  const std::vector<Break>& breaks() const { return breaks_; }

 private:
  bool cut(RobotId from, RobotId to, double t) const;
  bool in_reach(RobotId from, RobotId to) const;

  RadioSpec spec_;
  const OccupancyGrid& truth_;
  Where where_;
  std::vector<Break> breaks_;
  std::vector<RobotId> deaf_;
  std::mt19937_64 random_;
};

}  // namespace outrider::link
