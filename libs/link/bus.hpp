#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "world/messages.hpp"

namespace outrider::link {

/// A message as it arrived.
struct Delivery {
  RobotId from = 0;
  std::shared_ptr<const Message> message;
};

/// One robot's end of the radio. Not thread-safe.
class Bus {
 public:
  virtual ~Bus() = default;
  virtual void send(Message message) = 0;          ///< to everybody who can hear it; never blocks
  virtual std::vector<Delivery> receive() = 0;     ///< what has arrived since the last call, oldest first
};

/// Decides the fate of one copy of a message: the delay until it arrives [s], or nothing when it is lost.
using LinkModel = std::function<std::optional<double>(RobotId from, RobotId to, double now_s)>;

}  // namespace outrider::link
