#include "link/private_network.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <string_view>

namespace outrider::link {
namespace {

bool write_to(const char* path, std::string_view text) {
  const int fd = open(path, O_WRONLY | O_CLOEXEC);
  if (fd < 0) return false;
  const bool ok = write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size());
  close(fd);
  return ok;
}

void set_address(sockaddr& where, const char* text) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  inet_aton(text, &address.sin_addr);
  std::memcpy(&where, &address, sizeof address);
}

/// ip link set lo up; ip route add 224.0.0.0/4 dev lo
bool set_up_loopback() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0) return false;
  char name[] = "lo";
  ifreq link{};
  std::memcpy(link.ifr_name, name, sizeof name);
  link.ifr_flags = IFF_UP | IFF_RUNNING;
  rtentry route{};
  set_address(route.rt_dst, "224.0.0.0");
  set_address(route.rt_genmask, "240.0.0.0");
  route.rt_flags = RTF_UP;
  route.rt_dev = name;
  const bool ok = ioctl(fd, SIOCSIFFLAGS, &link) == 0 && ioctl(fd, SIOCADDRT, &route) == 0;
  close(fd);
  return ok;
}

}  // namespace

bool enter_private_network() {
  if (unshare(CLONE_NEWNET) != 0) {  // not privileged: in a user namespace, as ourselves
    const std::string user = std::to_string(getuid()), group = std::to_string(getgid());
    if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
    if (!write_to("/proc/self/setgroups", "deny") || !write_to("/proc/self/uid_map", user + " " + user + " 1") ||
        !write_to("/proc/self/gid_map", group + " " + group + " 1"))
      return false;
  }
  return set_up_loopback();
}

}  // namespace outrider::link
