#pragma once
// One robot's end of an auction by messages: a state machine without sockets or clocks. The radio may lose, delay,
// repeat and reorder what is sent; robots may fall silent for ever.

#include <cstdint>
#include <vector>

#include "auction/bundles.hpp"
#include "world/messages.hpp"

namespace outrider::auction {

/// Rhythm of the messages, to be chosen by the radio: `dead_s` must be many times the usual delay and `repeat_s`, so that
/// no living robot is ever taken for dead. If one is, tasks change hands more often than needed, nothing worse.
struct NegotiationTimes {
  double repeat_s = 0.25;   ///< between repetitions of what was said last
  double dead_s = 6.0;      ///< a robot that was not heard for so long is taken for dead
  double back_off_s = 0.1;  ///< mean wait after a busy answer
};

class Negotiator {
 public:
  virtual ~Negotiator() = default;
  /// Messages of other auctions, and of other kinds, are ignored.
  virtual void hear(const Message& message, double now_s) = 0;
  /// Decides, and returns what to broadcast now. To be called every few hundredths of a second, also after done():
  /// others may not have heard yet.
  virtual std::vector<Message> act(double now_s) = 0;
  /// What this robot is to do, as far as it knows. Final when done() says so.
  virtual TaskSet tasks() const = 0;
  /// True once this robot knows that everybody alive agrees. May become false again when a robot dies.
  virtual bool done() const = 0;
  /// How often this robot's tasks changed.
  virtual int modifications() const = 0;
};

}  // namespace outrider::auction
