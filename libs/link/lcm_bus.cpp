#include "link/lcm_bus.hpp"

#include <poll.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <utility>

#include "link/lc02.hpp"

namespace outrider::link {
namespace {

constexpr std::size_t kInbox = 8192;     // messages; a team says less in a second
constexpr double kDeaf = 1.0;            // [s] without an echo
constexpr double kRetry = 0.5;           // [s] between attempts to get a socket
constexpr std::size_t kMostDrained = 4096;  // datagrams in one go: a flood must not hold up the robot

std::int64_t wall_clock_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

}  // namespace

LcmBus::LcmBus(const MulticastUrl& url, GuardSettings settings, Clock clock)
    : url_(url), settings_(settings), guard_(std::move(settings)), clock_(std::move(clock)) {
  watch(clock_());
}

void LcmBus::send(Message message) {
  const Envelope envelope{wall_clock_us(), settings_.boot, ++sequence_, settings_.run, settings_.self};
  std::vector<std::uint8_t> payload = encode(envelope, message);
  if (settings_.key) settings_.key->sign(payload);
  const auto datagram = make_lc02(static_cast<std::uint32_t>(sequence_), channel_of(message), payload);
  if (!socket_ || !socket_->send(datagram)) {
    ++counters_.unsent;
  } else {
    ++counters_.sent;
    counters_.bytes += datagram.size();
  }
  unanswered_s_ = std::min(unanswered_s_, clock_());
}

std::vector<Delivery> LcmBus::receive() {
  drain();
  return std::exchange(inbox_, {});
}

bool LcmBus::wait(double until_s) {
  drain();
  double now_s = clock_();
  watch(now_s);
  const double left_s = std::max(0.0, until_s - now_s);
  if (inbox_.empty()) {
    pollfd ready{socket_ ? socket_->fd() : -1, POLLIN, 0};
    const timespec timeout{static_cast<time_t>(left_s), static_cast<long>(std::fmod(left_s, 1.0) * 1e9)};
    ppoll(&ready, 1, &timeout, nullptr);
    drain();
  }
  return !inbox_.empty();
}

void LcmBus::drain() {
  std::array<std::uint8_t, kMostMessageBytes + 1> buffer;  // one more: a longer datagram shows
  const double now_s = clock_();
  for (std::size_t k = 0; socket_ && k < kMostDrained; ++k) {
    const auto size = socket_->receive(buffer);
    if (!size) break;
    auto delivery = guard_.accept({buffer.data(), *size}, now_s);
    if (guard_.echo_s() >= now_s) unanswered_s_ = 1e18;
    if (!delivery) continue;
    if (inbox_.size() >= kInbox) {
      guard_.reject(Rejection::kFull);
      continue;
    }
    ++counters_.delivered;
    inbox_.push_back(std::move(*delivery));
  }
}

/// Makes the socket anew when there is none, or when it has fallen deaf.
void LcmBus::watch(double now_s) {
  const bool deaf = now_s > unanswered_s_ + kDeaf;
  if ((socket_ && !deaf) || now_s < opened_s_ + kRetry) return;
  if (opened_s_ > 0.0) ++counters_.reopened;
  opened_s_ = now_s;
  socket_.reset();  // the port of the old one must not swallow datagrams
  socket_ = MulticastSocket::open(url_, trouble_);
  unanswered_s_ = 1e18;
}

}  // namespace outrider::link
