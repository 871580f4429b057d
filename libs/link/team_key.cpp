#include "link/team_key.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <vector>

#include "link/codec.hpp"
#include "world/error.hpp"

namespace outrider::link {
namespace {

using Mac = std::array<std::uint8_t, kMacBytes>;

Mac mac_of(std::span<const std::uint8_t> payload, const std::array<std::uint8_t, 32>& key) {
  constexpr Mac kZero{};
  Mac mac;
  crypto_generichash_state state;
  crypto_generichash_init(&state, key.data(), key.size(), mac.size());
  crypto_generichash_update(&state, payload.data(), kMacOffset);
  crypto_generichash_update(&state, kZero.data(), kZero.size());
  const auto rest = payload.subspan(kMacOffset + kMacBytes);
  crypto_generichash_update(&state, rest.data(), rest.size());
  crypto_generichash_final(&state, mac.data(), mac.size());
  return mac;
}

}  // namespace

TeamKey TeamKey::read(const std::filesystem::path& file) {
  constexpr std::size_t kLeast = 16, kMost = 65536;
  std::ifstream in(file, std::ios::binary);
  if (!std::filesystem::is_regular_file(file) || !in)
    throw InputError(fmt::format("{}: cannot read the team key", file.string()));
  const auto size = std::filesystem::file_size(file);
  if (size < kLeast || size > kMost)
    throw InputError(fmt::format("{}: a team key has {} to {} bytes, this file has {}", file.string(), kLeast, kMost, size));
  const std::vector<std::uint8_t> secret{std::istreambuf_iterator<char>(in), {}};
  return TeamKey(secret);
}

TeamKey::TeamKey(std::span<const std::uint8_t> secret) {
  if (sodium_init() < 0) throw std::runtime_error("libsodium does not start");
  crypto_generichash(key_.data(), key_.size(), secret.data(), secret.size(), nullptr, 0);
}

void TeamKey::sign(std::span<std::uint8_t> payload) const {
  const Mac mac = mac_of(payload, key_);
  std::copy(mac.begin(), mac.end(), payload.begin() + kMacOffset);
}

bool TeamKey::verify(std::span<const std::uint8_t> payload) const {
  if (payload.size() < kMacOffset + kMacBytes) return false;
  const Mac mac = mac_of(payload, key_);
  return sodium_memcmp(mac.data(), payload.data() + kMacOffset, mac.size()) == 0;
}

}  // namespace outrider::link
