// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

#include "common/link/descriptor_link.hpp"
#include "common/link/kinds.hpp"

namespace tread {
namespace {

class TcpServerLink final : public DescriptorLink {
 public:
  explicit TcpServerLink(const LinkAddress& address)
      : DescriptorLink(address.text), host_(address.host), port_(address.port) {
    attempt();
  }
  ~TcpServerLink() override {
    if (listener_ >= 0) ::close(listener_);
  }

 private:
  int openDevice(std::string& reason) override {
    if (listener_ < 0 && !beginListening(reason)) return -1;
    const int fd = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    const bool nobody = fd < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
    if (fd < 0) reason = nobody ? "nobody has connected" : systemReason(errno);
    const int at_once = 1;
    if (fd >= 0) ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
    return fd;
  }

  bool beginListening(std::string& reason) {
    sockaddr_in local{};
    local.sin_family = AF_INET;
    local.sin_port = htons(port_);
    local.sin_addr.s_addr = htonl(INADDR_ANY);
    if (!host_.empty() && ::inet_pton(AF_INET, host_.c_str(), &local.sin_addr) != 1) {
      reason = "\"" + host_ + "\" is no IPv4 number; write tcp-server:127.0.0.1:port";
      return false;
    }
    const int fd = ::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    // Else the port of an emulator that has just ended stays taken for a minute.
    const int again = 1;
    if (fd >= 0) ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &again, sizeof again);
    if (fd >= 0 && ::bind(fd, reinterpret_cast<const sockaddr*>(&local), sizeof local) == 0 &&
        ::listen(fd, 1) == 0) {
      listener_ = fd;
      return true;
    }
    reason = systemReason(errno);
    if (fd >= 0) ::close(fd);
    return false;
  }

  ssize_t writeSome(const uint8_t* bytes, size_t size) override {
    return ::send(descriptor(), bytes, size, MSG_NOSIGNAL);
  }

  std::string host_;
  uint16_t port_;
  int listener_ = -1;
};

}  // namespace

std::unique_ptr<Link> makeTcpServerLink(const LinkAddress& address) {
  return std::make_unique<TcpServerLink>(address);
}

}  // namespace tread
