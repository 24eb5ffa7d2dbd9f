// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/link/can_link.hpp"

#include <algorithm>
#include <cerrno>

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/link/descriptor_link.hpp"

namespace tread {
namespace {

static_assert(sizeof(can_frame) == 16, "the stream consists of frames of 16 bytes");

class CanLink final : public DescriptorLink {
 public:
  explicit CanLink(const LinkAddress& address)
      : DescriptorLink(address.text), interface_(address.path) {
    attempt();
  }

 private:
  int openDevice(std::string& reason) override {
    const int fd = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (fd >= 0 && isUp(fd, reason) && bindTo(fd)) return fd;
    if (reason.empty()) reason = systemReason(errno);
    if (fd >= 0) ::close(fd);
    return -1;
  }

  bool isUp(int fd, std::string& reason) const {
    ifreq request{};
    interface_.copy(request.ifr_name, IFNAMSIZ - 1);
    if (::ioctl(fd, SIOCGIFFLAGS, &request) != 0) return false;
    if ((request.ifr_flags & IFF_UP) == 0)
      reason = "the interface is down; ip link set " + interface_ + " up type can bitrate 500000";
    return reason.empty();
  }

  bool bindTo(int fd) const {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(::if_nametoindex(interface_.c_str()));
    return address.can_ifindex > 0 &&
           ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  }

  /// One frame per call; the caller repeats the call.
  ssize_t writeSome(const uint8_t* bytes, size_t size) override {
    const ssize_t count = ::write(descriptor(), bytes, std::min(size, sizeof(can_frame)));
    // The interface's queue is full, which is no failure.
    if (count < 0 && errno == ENOBUFS) errno = EAGAIN;
    return count;
  }

  std::string interface_;
};

}  // namespace

std::unique_ptr<Link> makeCanLink(const LinkAddress& address) {
  return std::make_unique<CanLink>(address);
}

}  // namespace tread
