#pragma once
// What stands between the air and a robot: every datagram passes here or is counted as rejected.

#include <map>
#include <optional>
#include <span>

#include "link/bus.hpp"
#include "link/codec.hpp"
#include "link/team_key.hpp"

namespace outrider::link {

struct GuardSettings {
  RobotId self = 0;
  int robots = 1;                ///< numbers 0 ... robots - 1 are in the team
  std::int32_t run = 0;
  std::int64_t boot = 0;         ///< of this robot
  GridGeometry geometry;         ///< cells outside it are refused
  std::optional<TeamKey> key;    ///< without one everybody is believed
  double most_per_s = 2000.0;    ///< messages of one sender, with bursts of one second's worth
};

/// Remembers which sequence numbers of a sender it has seen: the newest and the 63 before it.
class ReplayWindow {
 public:
  bool fresh(std::int64_t sequence) const;
  void note(std::int64_t sequence);

 private:
  std::int64_t newest_ = 0;
  std::uint64_t seen_ = 0;  // bit k: newest_ - k
};

/// Checks datagrams in the order of their cost: frame, channel, envelope, sender, MAC, sequence, lengths, values, map. State
/// is bounded by the size of the team. Not thread-safe; sees no clock.
class Guard {
 public:
  explicit Guard(GuardSettings settings) : settings_(std::move(settings)) {}

  /// The message, when it is one for this robot. Own messages that come back are noted in echo_s().
  std::optional<Delivery> accept(std::span<const std::uint8_t> datagram, double now_s);

  /// When an own message last came back [s]: whoever no longer hears itself hears nobody.
  double echo_s() const { return echo_s_; }
  const RejectionCounters& rejections() const { return rejections_; }
  void reject(Rejection why) { ++rejections_[why]; }

 private:
  struct Sender {
    std::int64_t boot = 0;
    ReplayWindow window;
    double tokens = 0.0;
    double since_s = 0.0;
  };
  std::optional<Rejection> objection(const Envelope& envelope, std::span<const std::uint8_t> payload, double now_s);
  bool too_many(Sender& sender, double now_s) const;
  bool in_map(const Message& message) const;
  bool allowed(RobotId robot, const Message& message) const;

  GuardSettings settings_;
  std::map<RobotId, Sender> senders_;  // of the team and one observer
  RejectionCounters rejections_;
  double echo_s_ = -1e9;
};

}  // namespace outrider::link
