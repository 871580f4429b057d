#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace outrider::link {

/// "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2097152", as LCM writes it.
struct MulticastUrl {
  in_addr group{};
  std::uint16_t port = 7667;
  int ttl = 0;                        ///< 0: does not leave this machine
  int receive_buffer = 2 * 1024 * 1024;  ///< [bytes]; the kernel grants at most net.core.rmem_max

  /// Throws InputError naming the part that is wrong.
  static MulticastUrl parse(const std::string& text);
};

/// A UDP multicast socket: joins the group on the interface that the route to it names, hears itself, never blocks.
class MulticastSocket {
 public:
  /// Nothing when the network is not there (no route to the group, no interface); `why` then says what is missing.
  static std::optional<MulticastSocket> open(const MulticastUrl& url, std::string& why);
  MulticastSocket(MulticastSocket&& other) noexcept : fd_(other.fd_), to_(other.to_) { other.fd_ = -1; }
  MulticastSocket& operator=(MulticastSocket&& other) noexcept;
  ~MulticastSocket();

  bool send(std::span<const std::uint8_t> datagram);
  /// The next datagram, cut to the buffer's size; nothing when there is none.
  std::optional<std::size_t> receive(std::span<std::uint8_t> buffer);
  int fd() const { return fd_; }

 private:
  MulticastSocket(int fd, const sockaddr_in& to) : fd_(fd), to_(to) {}
  int fd_;
  sockaddr_in to_;
};

}  // namespace outrider::link
