#pragma once
// LCM's short UDP message, both ways: "LC02", sequence, channel, 0, payload. liblcm is not used on the air: its receive
// thread dies of two hostile fragments, hands over the oldest data after a stall and goes deaf when an interface is
// re-created (docs/protocol.md); what it speaks is this.

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

#include "link/rejection.hpp"

namespace outrider::link {

struct Lc02 {
  std::uint32_t sequence = 0;  ///< of the sender's socket
  std::string_view channel;    ///< into the datagram
  std::span<const std::uint8_t> payload;
};

/// The parts of a datagram; they live as long as it does.
std::variant<Lc02, Rejection> parse_lc02(std::span<const std::uint8_t> datagram);

std::vector<std::uint8_t> make_lc02(std::uint32_t sequence, std::string_view channel,
                                    std::span<const std::uint8_t> payload);

}  // namespace outrider::link
