#pragma once
// From world's messages to the bytes of lcmtypes/ and back. Pure functions; whatever comes in, nothing is allocated
// before the declared lengths have been compared with the bytes that are there.

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "link/rejection.hpp"
#include "world/messages.hpp"

namespace outrider::link {

/// What opens every message on the air.
struct Envelope {
  std::int64_t utime_us = 0;  ///< sender's wall clock; no decision depends on it
  std::int64_t boot = 0;      ///< grows from start to start of one robot
  std::int64_t sequence = 0;  ///< grows by one a message of one boot
  std::int32_t run = 0;       ///< which team
  RobotId robot = 0;          ///< the sender
  friend bool operator==(const Envelope&, const Envelope&) = default;
};

/// Who only listens and asks for maps (outrider watch) has this number; it is in no team.
inline constexpr RobotId kObserver = 32000;

/// Where the 16 bytes of the MAC lie in a payload: behind fingerprint, utime, boot, sequence, run and robot.
inline constexpr std::size_t kMacOffset = 8 + 8 + 8 + 8 + 4 + 2, kMacBytes = 16;

struct Packet {
  Envelope envelope;
  Message message;
};

/// A message, or why there is none.
struct Decoded {
  std::optional<Packet> packet;
  Rejection why{};
};

/// The LCM channel of a kind of message, e.g. "OUTRIDER_STATUS".
std::string_view channel_of(const Message& message);
bool is_channel(std::string_view channel);

/// The LCM payload, MAC zero. The message is within the limits that its struct names; the sender's number is the
/// envelope's.
std::vector<std::uint8_t> encode(const Envelope& envelope, const Message& message);

/// The envelope of a payload without looking at the rest; nothing when it is too short for one.
std::optional<Envelope> peek(std::span<const std::uint8_t> payload);

/// Refuses another type, any length but the exact one, arrays above their limits, and values that cannot be: NaN and
/// infinities, negative numbers of cells and robots, truth values other than 0 and 1. O(bytes).
Decoded decode(std::string_view channel, std::span<const std::uint8_t> payload);

/// Bytes of the message as one UDP datagram, LCM's header and channel included, for any number of elements.
std::size_t encoded_size(const Message& message);

}  // namespace outrider::link
