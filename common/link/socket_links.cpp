// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/link/socket_links.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/link/descriptor_link.hpp"

namespace tread {
namespace {

constexpr int64_t kConnectDeadline = 1'000'000;  // [us]

struct Endpoint {
  sockaddr_storage address{};
  socklen_t size = 0;
};

/// The addresses of a host, IPv4 first: instruments and emulators listen there.
std::vector<Endpoint> lookUp(const std::string& host, uint16_t port, std::string& reason) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int error = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (error != 0) {
    reason = "host " + host + " is unknown (" + ::gai_strerror(error) + ")";
    return {};
  }
  std::vector<Endpoint> endpoints;
  for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) {
    Endpoint endpoint;
    std::memcpy(&endpoint.address, entry->ai_addr, entry->ai_addrlen);
    endpoint.size = entry->ai_addrlen;
    endpoints.push_back(endpoint);
  }
  ::freeaddrinfo(found);
  std::stable_partition(endpoints.begin(), endpoints.end(), [](const Endpoint& endpoint) {
    return endpoint.address.ss_family == AF_INET;
  });
  return endpoints;
}

/// Commands leave at once, and a peer that vanishes silently is detected within seconds.
void tune(int fd) {
  const auto set = [fd](int level, int option, int value) {
    ::setsockopt(fd, level, option, &value, sizeof value);
  };
  set(IPPROTO_TCP, TCP_NODELAY, 1);
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, 2);   // [s]
  set(IPPROTO_TCP, TCP_KEEPINTVL, 1);  // [s]
  set(IPPROTO_TCP, TCP_KEEPCNT, 3);
  set(IPPROTO_TCP, TCP_USER_TIMEOUT, 5000);  // [ms]
}

/// A connection to or at a port.
class SocketLink : public DescriptorLink {
 protected:
  explicit SocketLink(const LinkAddress& address)
      : DescriptorLink(address.text), host_(address.host), port_(address.port) {}
  ssize_t writeSome(const uint8_t* bytes, size_t size) override {
    return ::send(descriptor(), bytes, size, MSG_NOSIGNAL);
  }

  std::string host_;
  uint16_t port_;
};

class TcpLink final : public SocketLink {
 public:
  explicit TcpLink(const LinkAddress& address) : SocketLink(address) { attempt(); }
  ~TcpLink() override { abandon(); }

  bool reopen(int64_t utime) override {
    if (connecting_ < 0) {
      const bool open = DescriptorLink::reopen(utime);
      if (connecting_ >= 0) since_ = utime;
      return open;
    }
    if (!since_ || utime < *since_) since_ = utime;
    std::string reason;
    if (isConnected(reason)) {
      adopt(std::exchange(connecting_, -1));
      return true;
    }
    if (reason.empty() && utime - *since_ > kConnectDeadline) reason = "no answer within 1 s";
    if (!reason.empty()) {
      abandon();
      noteProblem(reason);
    }
    return false;
  }

 private:
  int openDevice(std::string& reason) override {
    if (endpoints_.empty()) endpoints_ = lookUp(host_, port_, reason);
    // After an address that refuses at once, try the host's next one.
    for (size_t tried = 0; tried < endpoints_.size(); ++tried) {
      begin(reason);
      if (connecting_ < 0) continue;
      if (isConnected(reason)) return std::exchange(connecting_, -1);
      if (reason.empty()) {
        reason = "connecting";
        return -1;
      }
      abandon();
    }
    return -1;
  }

  void begin(std::string& reason) {
    reason.clear();
    since_.reset();
    const Endpoint& endpoint = endpoints_[next_++ % endpoints_.size()];
    connecting_ =
        ::socket(endpoint.address.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (connecting_ < 0) {
      reason = systemReason(errno);
      return;
    }
    tune(connecting_);
    const auto* address = reinterpret_cast<const sockaddr*>(&endpoint.address);
    if (::connect(connecting_, address, endpoint.size) == 0 || errno == EINPROGRESS) return;
    reason = systemReason(errno);
    abandon();
  }

  /// Whether the connection is established; a reason if it never will be.
  bool isConnected(std::string& reason) const {
    pollfd entry{connecting_, POLLOUT, 0};
    if (::poll(&entry, 1, 0) <= 0) return false;
    int error = 0;
    socklen_t size = sizeof error;
    ::getsockopt(connecting_, SOL_SOCKET, SO_ERROR, &error, &size);
    if (error != 0) reason = systemReason(error);
    return error == 0;
  }

  void abandon() {
    if (connecting_ >= 0) ::close(connecting_);
    connecting_ = -1;
  }

  // A plain close would still send the queue: half a command.
  void dropQueued() override {
    const linger at_once{1, 0};
    ::setsockopt(descriptor(), SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  }

  std::vector<Endpoint> endpoints_;
  size_t next_ = 0;
  int connecting_ = -1;
  std::optional<int64_t> since_;  // utime at which connecting began, if known
};

/// A socket bound to a port of this host; an empty `host` means all of its addresses. -1 and the
/// reason on failure.
int boundSocket(int type, const std::string& host, uint16_t port, const std::string& example,
                std::string& reason) {
  sockaddr_in local{};
  local.sin_family = AF_INET;
  local.sin_port = htons(port);
  local.sin_addr.s_addr = htonl(INADDR_ANY);
  if (!host.empty() && ::inet_pton(AF_INET, host.c_str(), &local.sin_addr) != 1) {
    reason = "\"" + host + "\" is no IPv4 number; write " + example;
    return -1;
  }
  const int fd = ::socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  // Otherwise the port of an emulator that has just ended stays taken for a minute.
  const int again = 1;
  if (type == SOCK_STREAM && fd >= 0)
    ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &again, sizeof again);
  if (fd >= 0 && ::bind(fd, reinterpret_cast<const sockaddr*>(&local), sizeof local) == 0)
    return fd;
  reason = systemReason(errno);
  if (fd >= 0) ::close(fd);
  return -1;
}

class TcpServerLink final : public SocketLink {
 public:
  explicit TcpServerLink(const LinkAddress& address) : SocketLink(address) { attempt(); }
  ~TcpServerLink() override {
    if (listener_ >= 0) ::close(listener_);
  }

 private:
  int openDevice(std::string& reason) override {
    if (listener_ < 0 && !beginListening(reason)) return -1;
    const int fd = ::accept4(listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    const bool nobody = fd < 0 && (errno == EAGAIN || errno == EWOULDBLOCK);
    if (fd < 0) reason = nobody ? kNobody : systemReason(errno);
    const int at_once = 1;
    if (fd >= 0) ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof at_once);
    return fd;
  }

  bool beginListening(std::string& reason) {
    const int fd = boundSocket(SOCK_STREAM, host_, port_, "tcp-server:127.0.0.1:port", reason);
    if (fd < 0) return false;
    if (::listen(fd, 1) == 0) {
      listener_ = fd;
      return true;
    }
    reason = systemReason(errno);
    ::close(fd);
    return false;
  }

  int listener_ = -1;
};

class UdpLink final : public SocketLink {
 public:
  explicit UdpLink(const LinkAddress& address) : SocketLink(address) { attempt(); }

  bool write(const uint8_t* /*bytes*/, size_t /*size*/) override { return false; }

 private:
  int openDevice(std::string& reason) override {
    const int fd = boundSocket(SOCK_DGRAM, host_, port_, "udp:port or udp:127.0.0.1:port", reason);
    if (fd >= 0) taken_ = datagram_.size();
    return fd;
  }

  /// The rest of the last datagram, else the next one: a short buffer must not truncate it.
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

  std::vector<uint8_t> datagram_;
  size_t taken_ = 0;
};

}  // namespace

std::unique_ptr<Link> makeTcpLink(const LinkAddress& address) {
  return std::make_unique<TcpLink>(address);
}

std::unique_ptr<Link> makeTcpServerLink(const LinkAddress& address) {
  return std::make_unique<TcpServerLink>(address);
}

std::unique_ptr<Link> makeUdpLink(const LinkAddress& address) {
  return std::make_unique<UdpLink>(address);
}

}  // namespace tread
