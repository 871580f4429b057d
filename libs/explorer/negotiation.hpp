#pragma once
// A team that negotiates over the simulated radio, robot by robot, in simulated time.

#include <functional>
#include <memory>
#include <vector>

#include "auction/negotiator.hpp"
#include "link/ether.hpp"

namespace outrider::explorer {

struct NegotiationSettings {
  double act_s = 0.02;      ///< mean time between two decisions of a robot; each robot has a rhythm of its own [s]
  double loss = 0.0;        ///< probability that a copy of a message is lost
  double delay_s = 0.01;    ///< mean delay of a copy, uniform from 0 to twice that: messages overtake each other [s]
  double duplicate = 0.0;   ///< probability that a copy is heard once more, up to 1 s later
  std::vector<std::pair<RobotId, double>> deaths;  ///< robots that fall silent for ever, and when [s]
  auction::NegotiationTimes times;
  double most_s = 600.0;    ///< give up after [s]
  std::uint64_t seed = 1;   ///< of rhythms and radio
};

struct NegotiationPoint {
  double t = 0.0;
  std::vector<TaskSet> tasks;  ///< of each robot, as it sees them itself
};

struct NegotiationResult {
  auction::Allocation allocation;  ///< of the living; what dead robots believed does not count
  bool agreed = false;             ///< everybody alive was done
  double duration_s = 0.0;
  std::vector<int> modifications;
  link::RadioCounters radio;
  std::vector<NegotiationPoint> history;  ///< each time that somebody's tasks changed
};

using MakeNegotiator = std::function<std::unique_ptr<auction::Negotiator>(RobotId)>;

/// Runs until all living robots are done and all deaths have come and been noticed. Deterministic.
NegotiationResult negotiate(int robots, const MakeNegotiator& make, const NegotiationSettings& settings);

}  // namespace outrider::explorer
