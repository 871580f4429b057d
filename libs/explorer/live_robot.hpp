#pragma once
// One robot on the wall clock: the same Explorer as in the simulator, a body, and the air.

#include <atomic>
#include <functional>

#include "explorer/journal.hpp"

namespace outrider::explorer {

/// A body that moves by itself, or is moved step by step (a simulated one).
struct LiveBody {
  Body* body = nullptr;
  std::function<void()> step = [] {};                     ///< one period has passed
  std::function<double()> path_m = [] { return 0.0; };    ///< driven so far [m]
};

struct LiveSettings {
  RobotId self = 0;
  std::vector<RobotSpec> team;
  GridGeometry geometry;
  std::string coordinator = "daa";
  CoordinatorSettings coordination;
  ExplorerSettings explorer;
  MapperFactory make_mapper;     ///< for bodies that scan; without it they sense cells
  double time_scale = 1.0;       ///< how much faster than the wall clock; told to listeners
  double period_s = 0.1;         ///< of sensing and acting [s]
  double most_s = 0.0;           ///< give up after this; 0: never
  double silent_is_gone_s = 60.0;  ///< a team-mate not heard for so long is not waited for [s]
  double linger_s = 3.0;         ///< how long all must be done before this robot leaves [s]
};

/// `now_s` of the run and how to wait for mail until then; both on the run's own, perhaps faster, clock.
struct LiveClock {
  std::function<double()> now_s;
  std::function<bool(double until_s)> wait_for_mail;
};

/// Explores until the whole team is done: everybody, as last heard, has nothing left and the same map as this robot, or
/// has been silent for long. Journal lines and events go out
/// as they arise; the counters of the bus in the farewell are the caller's to fill in.
LiveFarewell run_live(const LiveSettings& settings, LiveBody body, link::Bus& bus, const LiveClock& clock,
                      const std::atomic<bool>& interrupted, const LineSink& journal, const EventSink& events);

}  // namespace outrider::explorer
