#pragma once
// The in-memory twin of the radio: endpoints of one team, a link model that may lose or delay, exact counters.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "link/bus.hpp"

namespace outrider::link {

/// Everybody hears everybody at once.
inline LinkModel ideal_link() {
  return [](RobotId, RobotId, double) { return std::optional<double>(0.0); };
}

struct RadioCounters {
  std::uint64_t sent = 0;       ///< messages handed to the radio
  std::uint64_t delivered = 0;  ///< copies that reached a receiver
  std::uint64_t bytes = 0;      ///< of the messages sent, by encoded_size()
};

/// Connects `robots` endpoints in one process. Deterministic: deliveries are ordered by (arrival time, send order).
/// Not thread-safe; must outlive its endpoints.
class Ether {
 public:
  Ether(int robots, LinkModel model);
  ~Ether();

  Bus& endpoint(RobotId robot);
  void set_time(double now_s) { now_s_ = now_s; }
  /// True when some endpoint has mail that has arrived by now.
  bool pending() const;
  const RadioCounters& counters() const { return counters_; }

 private:
  struct Endpoint;
  struct InFlight {
    double arrival_s;
    std::uint64_t order;
    Delivery delivery;
  };
  void send_from(RobotId from, Message message);

  LinkModel model_;
  double now_s_ = 0.0;
  std::uint64_t order_ = 0;
  RadioCounters counters_;
  std::vector<std::unique_ptr<Endpoint>> endpoints_;
};

}  // namespace outrider::link
