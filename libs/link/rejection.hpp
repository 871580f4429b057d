#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace outrider::link {

/// Why something that arrived was not listened to.
enum class Rejection : std::uint8_t {
  kNoLcm,     ///< no LC02 header, or a channel name without an end
  kFragment,  ///< a part of a long LCM message; ours fit into one frame
  kChannel,   ///< not one of ours
  kLong,      ///< more than kMostMessageBytes
  kType,      ///< another fingerprint: another version of the message
  kLength,    ///< not exactly as long as it says
  kValue,     ///< a number that cannot be
  kRun,       ///< another team's
  kRobot,     ///< a sender that is not in the team
  kTwin,      ///< somebody else with this robot's number
  kKey,       ///< not signed with the team's key
  kReplay,    ///< seen before, or too old to tell
  kRate,      ///< too many from one sender
  kMap,       ///< names a cell outside the map, or a robot outside the team
  kFull,      ///< arrived faster than it was read
};
inline constexpr std::size_t kRejections = 15;

inline constexpr std::array<std::string_view, kRejections> kRejectionNames{
    "no LCM message", "fragment", "unknown channel", "too long", "other type", "wrong length", "impossible value",
    "other run", "unknown robot", "own number", "wrong key", "replayed", "too many", "outside map or team", "inbox full"};

struct RejectionCounters {
  std::array<std::uint64_t, kRejections> count{};
  std::uint64_t& operator[](Rejection why) { return count[static_cast<std::size_t>(why)]; }
  std::uint64_t operator[](Rejection why) const { return count[static_cast<std::size_t>(why)]; }
};

}  // namespace outrider::link
