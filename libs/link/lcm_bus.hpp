#pragma once
// The radio of a live robot: LCM over UDP multicast, guarded.

#include <functional>
#include <string>
#include <vector>

#include "link/bus.hpp"
#include "link/guard.hpp"
#include "link/multicast.hpp"

namespace outrider::link {

struct LcmBusCounters {
  std::uint64_t sent = 0;       ///< datagrams
  std::uint64_t bytes = 0;      ///< of these
  std::uint64_t unsent = 0;     ///< the network refused them
  std::uint64_t delivered = 0;  ///< messages of others that passed the guard
  std::uint64_t reopened = 0;   ///< times the socket was made anew
};

/// Sends each message as one datagram; receives on the caller's thread, into a bounded inbox. A robot that sends and no
/// longer hears itself has lost its network (its interface went away, perhaps came back): the socket is made anew, again
/// and again, until it does. Starts without a network, too.
class LcmBus : public Bus {
 public:
  using Clock = std::function<double()>;  ///< monotonic [s]
  LcmBus(const MulticastUrl& url, GuardSettings settings, Clock clock);

  void send(Message message) override;
  std::vector<Delivery> receive() override;

  /// Reads what is on the socket, waiting for it until `until_s` at most. True when mail is there.
  bool wait(double until_s);
  bool connected() const { return socket_.has_value(); }
  const std::string& trouble() const { return trouble_; }  ///< why not connected
  const LcmBusCounters& counters() const { return counters_; }
  const RejectionCounters& rejections() const { return guard_.rejections(); }

 private:
  void drain();
  void watch(double now_s);

  MulticastUrl url_;
  GuardSettings settings_;
  Guard guard_;
  Clock clock_;
  std::optional<MulticastSocket> socket_;
  std::string trouble_;
  std::vector<Delivery> inbox_;
  LcmBusCounters counters_;
  std::int64_t sequence_ = 0;
  double unanswered_s_ = 1e18;   // first send since the last echo
  double opened_s_ = -1e9;       // last attempt
};

}  // namespace outrider::link
