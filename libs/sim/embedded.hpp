#pragma once
// Internal to the room: the texts of datasets/*.txt, written into the build by datasets/CMakeLists.txt.

#include <span>
#include <string_view>

namespace outrider::sim {

struct EmbeddedText {
  std::string_view name;
  std::string_view text;
};

/// Sorted by name.
std::span<const EmbeddedText> embedded_texts();

}  // namespace outrider::sim
