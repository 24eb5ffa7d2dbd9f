// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Protocol (lcm_tcpq.c of liblcm 1.3.1), all numbers 32 bit big endian: both sides begin with their
// magic word and version; then PUBLISH is type, length, channel, length, bytes in both directions,
// SUBSCRIBE and UNSUBSCRIBE are type, length, channel (a regular expression).
#include "common/bus/tcp_relay.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <regex>
#include <stdexcept>
#include <vector>

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

namespace tread {
namespace {

constexpr uint32_t kServerMagic = 0x287617fa;
constexpr uint32_t kClientMagic = 0x287617fb;
constexpr uint32_t kVersion = 0x0100;
constexpr uint32_t kPublish = 1;
constexpr uint32_t kSubscribe = 2;
constexpr uint32_t kUnsubscribe = 3;
constexpr size_t kLongestField = 1'000'000;  // [bytes]; our messages have at most 60 000
constexpr size_t kLongestChannel = 63;       // [bytes], as in LCM
constexpr size_t kLongestPattern = 250;      // [bytes] of a subscription
constexpr size_t kMostUnsent = 4'000'000;    // [bytes] queued for one receiver

std::string bytesOf(uint32_t number) {
  const uint32_t big_endian = htonl(number);
  return {reinterpret_cast<const char*>(&big_endian), sizeof big_endian};
}

/// Extracts fields from the front of a buffer; leaves it unchanged if a field is incomplete.
class Fields {
 public:
  explicit Fields(const std::string& buffer) : buffer_(buffer) {}
  std::optional<uint32_t> number() {
    if (buffer_.size() - used_ < 4) return std::nullopt;
    uint32_t value = 0;
    std::memcpy(&value, buffer_.data() + used_, sizeof value);
    used_ += 4;
    return ntohl(value);
  }
  /// Throws std::runtime_error for a length beyond that of any message.
  std::optional<std::string> text(size_t longest) {
    const auto size = number();
    if (size && *size > longest) throw std::runtime_error("a field is too long");
    if (!size || buffer_.size() - used_ < *size) return std::nullopt;
    used_ += *size;
    return buffer_.substr(used_ - *size, *size);
  }
  size_t used() const { return used_; }

 private:
  const std::string& buffer_;
  size_t used_ = 0;
};

struct Client {
  explicit Client(int descriptor) : socket(descriptor) {}
  ~Client() { close(socket); }
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;

  bool wants(const std::string& channel) {
    const auto [known, added] = wanted.try_emplace(channel, false);
    if (added)
      known->second = std::any_of(
          subscriptions.begin(), subscriptions.end(),
          [&](const std::string& text) { return std::regex_match(channel, std::regex(text)); });
    return known->second;
  }

  int socket;
  bool greeted = false;
  std::string received;
  std::string unsent = bytesOf(kServerMagic) + bytesOf(kVersion);
  std::vector<std::string> subscriptions;
  std::map<std::string, bool> wanted;  ///< by channel, for channels seen so far
};

class Relay {
 public:
  Relay(int listener, int stop) : listener_(listener), stop_(stop) {}

  void run() {
    for (;;) {
      std::vector<pollfd> waiting{{stop_, POLLIN, 0}, {listener_, POLLIN, 0}};
      for (const auto& client : clients_) {
        const int events = POLLIN | (client->unsent.empty() ? 0 : POLLOUT);
        waiting.push_back({client->socket, static_cast<short>(events), 0});
      }
      if (poll(waiting.data(), waiting.size(), -1) < 0) continue;
      if (waiting[0].revents != 0) return;
      for (size_t i = 0; i + 2 < waiting.size(); ++i)
        if (waiting[i + 2].revents != 0 && !serve(*clients_[i])) clients_[i].reset();
      clients_.erase(std::remove(clients_.begin(), clients_.end(), nullptr), clients_.end());
      if (waiting[1].revents != 0) accept();
    }
  }

 private:
  void accept() {
    const int socket = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
    if (socket < 0) return;
    const int on = 1;
    setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    clients_.push_back(std::make_unique<Client>(socket));
  }

  /// False if the client has gone or violates the protocol.
  bool serve(Client& client) {
    char piece[65536];
    const ssize_t size = recv(client.socket, piece, sizeof piece, 0);
    if (size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR)) return false;
    if (size > 0) {
      // liblcm sends a message in five pieces and waits for our acknowledgement of the first.
      const int on = 1;
      setsockopt(client.socket, IPPROTO_TCP, TCP_QUICKACK, &on, sizeof on);
      client.received.append(piece, static_cast<size_t>(size));
      try {
        while (takeMessage(client)) {
        }
      } catch (const std::exception&) {
        return false;
      }
    }
    return flush(client);
  }

  static bool flush(Client& client) {
    const ssize_t sent =
        send(client.socket, client.unsent.data(), client.unsent.size(), MSG_NOSIGNAL);
    if (sent > 0) client.unsent.erase(0, static_cast<size_t>(sent));
    return sent >= 0 || errno == EAGAIN || errno == EINTR;
  }

  /// False if there is no whole message; throws std::exception if the client does not speak tcpq.
  bool takeMessage(Client& client) {
    Fields fields(client.received);
    const auto first = fields.number();
    if (!first) return false;
    if (!client.greeted) {
      if (*first != kClientMagic) throw std::runtime_error("no client of LCM");
      if (!fields.number()) return false;
      client.greeted = true;
    } else {
      // std::regex recurses for each character of either.
      const auto channel = fields.text(*first == kPublish ? kLongestChannel : kLongestPattern);
      if (!channel) return false;
      if (*first == kPublish) {
        const auto bytes = fields.text(kLongestField);
        if (!bytes) return false;
        passOn(*channel, *bytes);
      } else {
        subscribe(client, *first, *channel);
      }
    }
    client.received.erase(0, fields.used());
    return true;
  }

  static void subscribe(Client& client, uint32_t type, const std::string& channel) {
    if (type != kSubscribe && type != kUnsubscribe) throw std::runtime_error("unknown message");
    static_cast<void>(std::regex(channel));  // an invalid one ends this client, not its publisher
    auto& all = client.subscriptions;
    const auto found = std::find(all.begin(), all.end(), channel);
    if (type == kSubscribe)
      all.push_back(channel);
    else if (found != all.end())
      all.erase(found);
    client.wanted.clear();
  }

  void passOn(const std::string& channel, const std::string& bytes) {
    const std::string message = bytesOf(kPublish) + bytesOf(static_cast<uint32_t>(channel.size())) +
                                channel + bytesOf(static_cast<uint32_t>(bytes.size())) + bytes;
    for (const auto& client : clients_) {
      if (!client || client->unsent.size() > kMostUnsent || !client->wants(channel)) continue;
      client->unsent += message;
      flush(*client);  // a client that has gone is detected when it is served
    }
  }

  int listener_;
  int stop_;
  std::vector<std::unique_ptr<Client>> clients_;
};

}  // namespace

TcpRelay::TcpRelay(uint16_t port)
    : listener_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)), stop_(eventfd(0, EFD_CLOEXEC)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  socklen_t size = sizeof address;
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  const int on = 1;
  setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (bind(listener_, generic, size) != 0 || listen(listener_, 64) != 0 ||
      getsockname(listener_, generic, &size) != 0) {
    const std::string why = std::strerror(errno);
    close(listener_);
    close(stop_);
    throw std::runtime_error("TCP port " + std::to_string(port) + " on 127.0.0.1 cannot be used (" +
                             why + "); choose another with --lcm-url tcpq://127.0.0.1:PORT");
  }
  port_ = ntohs(address.sin_port);
  // Signals are handled by the program's other threads.
  sigset_t all;
  sigset_t before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ = std::thread([this] { Relay(listener_, stop_).run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

TcpRelay::~TcpRelay() {
  eventfd_write(stop_, 1);
  thread_.join();
  close(listener_);
  close(stop_);
}

std::string TcpRelay::url() const {
  return "tcpq://127.0.0.1:" + std::to_string(port_);
}

}  // namespace tread
