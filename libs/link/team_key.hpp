#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>

namespace outrider::link {

/// A secret that a team shares: who does not have it is noise. MAC: keyed BLAKE2b, 16 bytes, over the whole payload
/// with the MAC's place zero (libsodium). It keeps others from speaking, not from listening.
class TeamKey {
 public:
  /// Any file of at least 16 bytes, e.g. from `head -c 32 /dev/urandom`. Throws InputError naming it.
  static TeamKey read(const std::filesystem::path& file);
  explicit TeamKey(std::span<const std::uint8_t> secret);

  /// Fills in the MAC. The payload is one of the codec's.
  void sign(std::span<std::uint8_t> payload) const;
  bool verify(std::span<const std::uint8_t> payload) const;

 private:
  std::array<std::uint8_t, 32> key_{};
};

}  // namespace outrider::link
