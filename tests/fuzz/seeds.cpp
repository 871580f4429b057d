// Writes a corpus to begin with: some datagrams of every kind.

#include <filesystem>
#include <fstream>

#include "link/codec.hpp"
#include "link/lc02.hpp"
#include "link/random_message.hpp"

int main(int argc, char** argv) {
  using namespace outrider;
  if (argc != 2) return 2;
  std::filesystem::create_directories(argv[1]);
  for (std::size_t kind = 0; kind < test::MessageSource::kKinds; ++kind)
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Message message = test::MessageSource(seed).draw(kind, 3);
      const auto datagram = link::make_lc02(1, link::channel_of(message), link::encode({0, 5, 1, 42, 3}, message));
      std::ofstream out(std::filesystem::path(argv[1]) / (std::to_string(kind) + "-" + std::to_string(seed)), std::ios::binary);
      out.write(reinterpret_cast<const char*>(datagram.data()), static_cast<std::streamsize>(datagram.size()));
    }
  return 0;
}
