#include "link/lc02.hpp"

#include <algorithm>

namespace outrider::link {
namespace {

constexpr std::uint32_t kShort = 0x4c433032, kFragment = 0x4c433033;  // "LC02", "LC03"
constexpr std::size_t kLongestChannel = 63;

std::uint32_t big_endian32(std::span<const std::uint8_t> bytes, std::size_t at) {
  return static_cast<std::uint32_t>(bytes[at]) << 24U | static_cast<std::uint32_t>(bytes[at + 1]) << 16U |
         static_cast<std::uint32_t>(bytes[at + 2]) << 8U | bytes[at + 3];
}

}  // namespace

std::variant<Lc02, Rejection> parse_lc02(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < 8) return Rejection::kNoLcm;
  const std::uint32_t magic = big_endian32(datagram, 0);
  if (magic == kFragment) return Rejection::kFragment;
  if (magic != kShort) return Rejection::kNoLcm;
  const auto rest = datagram.subspan(8);
  const auto window = rest.first(std::min(rest.size(), kLongestChannel + 1));
  const auto end = std::find(window.begin(), window.end(), 0);
  if (end == window.end()) return Rejection::kNoLcm;
  const auto length = static_cast<std::size_t>(end - window.begin());
  return Lc02{big_endian32(datagram, 4), {reinterpret_cast<const char*>(rest.data()), length}, rest.subspan(length + 1)};
}

std::vector<std::uint8_t> make_lc02(std::uint32_t sequence, std::string_view channel,
                                    std::span<const std::uint8_t> payload) {
  std::vector<std::uint8_t> datagram;
  datagram.reserve(8 + channel.size() + 1 + payload.size());
  for (const std::uint32_t word : {kShort, sequence})
    for (const unsigned shift : {24U, 16U, 8U, 0U}) datagram.push_back(static_cast<std::uint8_t>(word >> shift));
  datagram.insert(datagram.end(), channel.begin(), channel.end());
  datagram.push_back(0);
  datagram.insert(datagram.end(), payload.begin(), payload.end());
  return datagram;
}

}  // namespace outrider::link
