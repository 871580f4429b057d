#include "link/multicast.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

#include "world/error.hpp"

namespace outrider::link {
namespace {

int whole_number(std::string_view text, const std::string& url, const char* what, int low, int high) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < low || value > high)
    throw InputError(fmt::format("{}: {}: expected a number from {} to {}, not '{}'", url, what, low, high, text));
  return value;
}

template <class T>
bool set(int fd, int level, int option, const T& value) {
  return setsockopt(fd, level, option, &value, sizeof value) == 0;
}

}  // namespace

MulticastUrl MulticastUrl::parse(const std::string& text) {
  constexpr std::string_view kScheme = "udpm://";
  std::string_view rest = text;
  if (!rest.starts_with(kScheme))
    throw InputError(fmt::format("{}: expected udpm://GROUP:PORT?ttl=N, e.g. udpm://239.255.76.67:7667?ttl=0", text));
  rest.remove_prefix(kScheme.size());
  MulticastUrl url;
  std::string_view query;
  if (const auto mark = rest.find('?'); mark != rest.npos) {
    query = rest.substr(mark + 1);
    rest = rest.substr(0, mark);
  }
  const auto colon = rest.find(':');
  const std::string group(rest.empty() ? "239.255.76.67" : rest.substr(0, colon));
  if (inet_aton(group.c_str(), &url.group) == 0 || !IN_MULTICAST(ntohl(url.group.s_addr)))
    throw InputError(fmt::format("{}: '{}' is no multicast address (224.0.0.0 to 239.255.255.255)", text, group));
  if (colon != rest.npos)
    url.port = static_cast<std::uint16_t>(whole_number(rest.substr(colon + 1), text, "port", 1, 65535));
  while (!query.empty()) {
    const auto end = query.find('&');
    const std::string_view piece = query.substr(0, end);
    query = end == query.npos ? std::string_view() : query.substr(end + 1);
    const auto equals = piece.find('=');
    const std::string_view key = piece.substr(0, equals);
    const std::string_view value = equals == piece.npos ? std::string_view() : piece.substr(equals + 1);
    if (key == "ttl") url.ttl = whole_number(value, text, "ttl", 0, 255);
    else if (key == "recv_buf_size") url.receive_buffer = whole_number(value, text, "recv_buf_size", 2048, 1 << 30);
    else throw InputError(fmt::format("{}: unknown part '{}'; known: ttl, recv_buf_size", text, key));
  }
  return url;
}

std::optional<MulticastSocket> MulticastSocket::open(const MulticastUrl& url, std::string& why) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) {
    why = std::string("socket: ") + std::strerror(errno);
    return std::nullopt;
  }
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(url.port);
  at.sin_addr = url.group;
  MulticastSocket opened(fd, at);
  const auto fails = [&](const char* what) {
    why = fmt::format("{}: {}", what, std::strerror(errno));
    return std::nullopt;
  };
  set(fd, SOL_SOCKET, SO_RCVBUF, url.receive_buffer);
  if (!set(fd, SOL_SOCKET, SO_REUSEADDR, 1)) return fails("SO_REUSEADDR");
  // Bound to the group, not to every address: another group on the same port stays out.
  if (bind(fd, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) return fails("bind");
  set(fd, IPPROTO_IP, IP_MULTICAST_ALL, 0);
  const ip_mreqn group{url.group, {INADDR_ANY}, 0};
  if (!set(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, group)) return fails("no route to the multicast group");
  const auto ttl = static_cast<unsigned char>(url.ttl), loop = static_cast<unsigned char>(1);
  if (!set(fd, IPPROTO_IP, IP_MULTICAST_TTL, ttl)) return fails("IP_MULTICAST_TTL");
  if (!set(fd, IPPROTO_IP, IP_MULTICAST_LOOP, loop)) return fails("IP_MULTICAST_LOOP");
  return opened;
}

MulticastSocket& MulticastSocket::operator=(MulticastSocket&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(to_, other.to_);
  return *this;
}

MulticastSocket::~MulticastSocket() {
  if (fd_ >= 0) close(fd_);
}

bool MulticastSocket::send(std::span<const std::uint8_t> datagram) {
  return sendto(fd_, datagram.data(), datagram.size(), MSG_NOSIGNAL, reinterpret_cast<const sockaddr*>(&to_),
                sizeof to_) == static_cast<ssize_t>(datagram.size());
}

std::optional<std::size_t> MulticastSocket::receive(std::span<std::uint8_t> buffer) {
  const ssize_t size = recv(fd_, buffer.data(), buffer.size(), MSG_DONTWAIT);
  return size < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(size));
}

}  // namespace outrider::link
