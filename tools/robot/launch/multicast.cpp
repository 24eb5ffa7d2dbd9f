// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/multicast.hpp"

#include <algorithm>
#include <cstring>

#include <arpa/inet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tools/robot/launch/host.hpp"
#include "tools/robot/launch/run_command.hpp"

namespace tread::launch {
namespace {

/// A socket that closes itself.
class Socket {
 public:
  Socket() : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)) {}
  ~Socket() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Whether a datagram to the group, sent as LCM sends it, comes back within a second; a busy
/// host may need a good part of it.
bool delivered(const LcmAddress& address) {
  const Socket socket;
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_addr.s_addr = htonl(INADDR_ANY);
  ip_mreq group{};
  if (inet_pton(AF_INET, address.group.c_str(), &group.imr_multiaddr) != 1) return false;
  socklen_t size = sizeof place;
  auto* generic = reinterpret_cast<sockaddr*>(&place);
  if (bind(socket.get(), generic, sizeof place) != 0 ||
      getsockname(socket.get(), generic, &size) != 0 ||
      setsockopt(socket.get(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &group, sizeof group) != 0)
    return false;
  const auto ttl = static_cast<unsigned char>(address.ttl);
  setsockopt(socket.get(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  place.sin_addr = group.imr_multiaddr;
  const char word[] = "tread-launch";
  if (sendto(socket.get(), word, sizeof word, 0, generic, sizeof place) != sizeof word)
    return false;
  pollfd waiting{socket.get(), POLLIN, 0};
  return poll(&waiting, 1, 1000) == 1;
}

/// Of this process's network namespace; sysfs may show another one.
unsigned int loopbackFlags() {
  const Socket socket;
  ifreq request{};
  std::strcpy(request.ifr_name, "lo");
  if (ioctl(socket.get(), SIOCGIFFLAGS, &request) != 0) return 0;
  return static_cast<unsigned short>(request.ifr_flags);
}

/// How much of a wanted receive buffer the kernel grants; it doubles what it is asked for.
int64_t grantedBuffer(int64_t wanted) {
  const Socket socket;
  int size = static_cast<int>(std::min<int64_t>(wanted, 1 << 30));
  setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &size, sizeof size);
  socklen_t length = sizeof size;
  getsockopt(socket.get(), SOL_SOCKET, SO_RCVBUF, &size, &length);
  return size / 2;
}

}  // namespace

NetworkFacts networkFacts(const LcmAddress& address) {
  NetworkFacts facts;
  if (address.provider != "udpm") return facts;
  facts.can_ask = !findProgram("ip", "").empty();
  facts.route_device = routeDevice(runCommand({"ip", "route", "get", address.group}, 5.0).output);
  const unsigned int flags = loopbackFlags();
  facts.loopback_up = (flags & IFF_UP) != 0;
  facts.loopback_multicast = (flags & IFF_MULTICAST) != 0;
  facts.delivered = delivered(address);
  facts.receive_buffer = grantedBuffer(std::max(kWantedBuffer, address.receive_buffer));
  return facts;
}

}  // namespace tread::launch
