// Whatever arrives: the guard neither crashes nor allocates more than a frame's worth, and what it lets through says
// the same when it is sent again.

#include <cstdlib>

#include "link/event_log.hpp"
#include "link/guard.hpp"
#include "link/lc02.hpp"

using namespace outrider;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> datagram(data, size);
  link::Guard guard({.self = 7, .robots = 8, .run = 42, .boot = 1, .geometry = {0.25, {-3.0, 2.0}, 320, 256}});
  guard.accept(datagram, 0.0);
  const auto frame = link::parse_lc02(datagram);
  const auto* message = std::get_if<link::Lc02>(&frame);
  if (message == nullptr) return 0;
  const link::Decoded decoded = link::decode(message->channel, message->payload);
  if (!decoded.packet) return 0;
  auto again = link::encode(decoded.packet->envelope, decoded.packet->message);
  std::copy_n(message->payload.begin() + link::kMacOffset, link::kMacBytes, again.begin() + link::kMacOffset);
  if (!std::equal(again.begin(), again.end(), message->payload.begin(), message->payload.end())) std::abort();
  return 0;
}
