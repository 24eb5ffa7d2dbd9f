// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <vector>

#include "common/link/descriptor_link.hpp"
#include "common/link/kinds.hpp"

namespace tread {
namespace {

class UdpLink final : public DescriptorLink {
 public:
  explicit UdpLink(const LinkAddress& address)
      : DescriptorLink(address.text), host_(address.host), port_(address.port) {
    attempt();
  }

  bool write(const uint8_t* /*bytes*/, size_t /*size*/) override { return false; }

 private:
  int openDevice(std::string& reason) override {
    sockaddr_in local{};
    local.sin_family = AF_INET;
    local.sin_port = htons(port_);
    local.sin_addr.s_addr = htonl(INADDR_ANY);
    if (!host_.empty() && ::inet_pton(AF_INET, host_.c_str(), &local.sin_addr) != 1) {
      reason = "\"" + host_ + "\" is no IPv4 number; write udp:port or udp:127.0.0.1:port";
      return -1;
    }
    const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (fd >= 0 && ::bind(fd, reinterpret_cast<const sockaddr*>(&local), sizeof local) == 0) {
      taken_ = datagram_.size();
      return fd;
    }
    reason = systemReason(errno);
    if (fd >= 0) ::close(fd);
    return -1;
  }

  /// What is left of the last datagram, else the next one: a short buffer must not cut it off.
  ssize_t readSome(uint8_t* buffer, size_t capacity) override {
    constexpr size_t kLargestDatagram = 65536;
    while (taken_ == datagram_.size()) {
      datagram_.resize(kLargestDatagram);
      const ssize_t count = ::recv(descriptor(), datagram_.data(), datagram_.size(), 0);
      datagram_.resize(static_cast<size_t>(std::max<ssize_t>(count, 0)));
      taken_ = 0;
      if (count < 0) return count;
    }
    const size_t count = std::min(capacity, datagram_.size() - taken_);
    std::memcpy(buffer, datagram_.data() + taken_, count);
    taken_ += count;
    return static_cast<ssize_t>(count);
  }

  std::string host_;
  uint16_t port_;
  std::vector<uint8_t> datagram_;
  size_t taken_ = 0;
};

}  // namespace

std::unique_ptr<Link> makeUdpLink(const LinkAddress& address) {
  return std::make_unique<UdpLink>(address);
}

}  // namespace tread
