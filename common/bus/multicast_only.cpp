// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/multicast_only.hpp"

#include <arpa/inet.h>
#include <linux/filter.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <lcm/lcm-cpp.hpp>

#include "common/bus/lcm_address.hpp"

namespace tread {
namespace {

[[noreturn]] void refuse(const std::string& url, const std::string& what) {
  throw std::runtime_error("LCM '" + url + "': " + what +
                           ", so other hosts could send messages; this process does not start");
}

int option(int descriptor, int name) {
  int value = -1;
  socklen_t size = sizeof value;
  return getsockopt(descriptor, SOL_SOCKET, name, &value, &size) == 0 ? value : -1;
}

bool isUdpOn(int descriptor, uint16_t port) {
  if (option(descriptor, SO_DOMAIN) != AF_INET || option(descriptor, SO_TYPE) != SOCK_DGRAM)
    return false;
  sockaddr_in place{};
  socklen_t size = sizeof place;
  return getsockname(descriptor, reinterpret_cast<sockaddr*>(&place), &size) == 0 &&
         ntohs(place.sin_port) == port;
}

/// The UDP sockets of this process on a port; none where /proc cannot be read.
std::set<int> udpSocketsOn(uint16_t port) {
  std::set<int> found;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", none)) {
    const int descriptor = std::atoi(entry.path().filename().c_str());
    if (isUdpOn(descriptor, port)) found.insert(descriptor);
  }
  return found;
}

template <size_t Size>
void attach(int descriptor, std::array<sock_filter, Size> code, const std::string& url) {
  const sock_fprog program{static_cast<unsigned short>(Size), code.data()};
  if (setsockopt(descriptor, SOL_SOCKET, SO_ATTACH_FILTER, &program, sizeof program) != 0)
    refuse(url, "the kernel refuses a filter on LCM's socket (" +
                    std::generic_category().message(errno) + ")");
}

/// Waits until LCM's thread has read the packets received before the filter; they are dropped for
/// lack of a subscriber.
void awaitEmpty(int descriptor, const std::string& url) {
  using std::chrono::steady_clock;
  const auto deadline = steady_clock::now() + std::chrono::seconds(5);
  for (int waiting = 1; waiting > 0;) {
    if (ioctl(descriptor, FIONREAD, &waiting) != 0 || steady_clock::now() > deadline)
      refuse(url, "LCM's socket does not run empty");
    if (waiting > 0) std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
}

void closeToOthers(int descriptor, uint32_t group, const std::string& url) {
  constexpr uint32_t kAll = UINT32_MAX;
  constexpr auto kDestination = static_cast<uint32_t>(SKF_NET_OFF + 16);  // in the IPv4 header
  attach(descriptor, std::array<sock_filter, 1>{{BPF_STMT(BPF_RET | BPF_K, 0)}}, url);
  awaitEmpty(descriptor, url);
  attach(
      descriptor,
      std::array<sock_filter, 4>{{BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kDestination),
                                  BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, group, 0, 1),
                                  BPF_STMT(BPF_RET | BPF_K, kAll), BPF_STMT(BPF_RET | BPF_K, 0)}},
      url);
  // Only through the interface on which LCM has joined the group, not those of other programs.
  const int off = 0;
  if (setsockopt(descriptor, IPPROTO_IP, IP_MULTICAST_ALL, &off, sizeof off) != 0)
    refuse(url, "LCM's socket cannot be kept to its own link");
  const int on = 1;
  if (setsockopt(descriptor, SOL_SOCKET, SO_LOCK_FILTER, &on, sizeof on) != 0)
    refuse(url, "the filter of LCM's socket cannot be locked");
}

}  // namespace

bool openForMulticastOnly(lcm::LCM& lcm, const std::string& url) {
  if (!lcm.good()) return false;
  const std::string effective = effectiveLcmUrl(url);
  const std::optional<LcmAddress> address = parseLcmUrl(effective);
  if (!address) refuse(effective, "the address cannot be read");
  if (address->provider != "udpm") return lcm.getFileno() >= 0;
  in_addr group{};
  if (inet_pton(AF_INET, address->group.c_str(), &group) != 1 || !IN_MULTICAST(ntohl(group.s_addr)))
    refuse(effective, address->group + " is no multicast group");
  // Leave another bus of this process, or a socket inherited from its parent, untouched.
  const std::set<int> others = udpSocketsOn(address->port);
  if (lcm.getFileno() < 0) return false;
  bool closed = false;
  for (const int descriptor : udpSocketsOn(address->port)) {
    if (others.count(descriptor) > 0) continue;
    closeToOthers(descriptor, ntohl(group.s_addr), effective);
    closed = true;
  }
  if (!closed) refuse(effective, "LCM's socket is not found in /proc/self/fd");
  return true;
}

}  // namespace tread
