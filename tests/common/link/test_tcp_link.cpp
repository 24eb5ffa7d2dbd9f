// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <utility>

#include <catch2/catch.hpp>

#include "common/link/make_link.hpp"
#include "link_helpers.hpp"

namespace tread {
namespace {

using testing::comesBack;
using testing::noticesEnd;
using testing::receive;
using testing::send;

/// A server on 127.0.0.1 with one client at a time.
class Server {
 public:
  /// On a given port, or on one chosen by the system.
  explicit Server(uint16_t wanted = 0) {
    const int on = 1;
    ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(wanted);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ::bind(listener_, reinterpret_cast<const sockaddr*>(&address), size);
    ::listen(listener_, 4);
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
  }
  ~Server() {
    hangUp();
    ::close(listener_);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  void accept() { client = ::accept(listener_, nullptr, nullptr); }
  void hangUp() {
    if (client >= 0) ::close(std::exchange(client, -1));
  }
  std::string link(const std::string& host = "127.0.0.1") const {
    return "tcp:" + host + ":" + std::to_string(port);
  }

  uint16_t port = 0;
  int client = -1;

 private:
  int listener_ = ::socket(AF_INET, SOCK_STREAM, 0);
};

}  // namespace

TEST_CASE("a TCP link talks both ways") {
  Server server;
  int64_t utime = 1'000'000;
  const auto link = makeLink(server.link());
  REQUIRE(comesBack(*link, utime));
  server.accept();
  CHECK(send(*link, "SCIP2.0\n"));
  char heard[16] = {};
  CHECK(::recv(server.client, heard, 8, MSG_WAITALL) == 8);
  CHECK(std::string(heard) == "SCIP2.0\n");
  CHECK(::send(server.client, "0\n\n", 3, 0) == 3);
  CHECK(receive(*link, 3) == "0\n\n");
  CHECK(link->address() == server.link());
}

TEST_CASE("a host's name is looked up, and an address that refuses gives way to the next") {
  if (::gethostbyname("localhost") == nullptr) {
    WARN("skipped: this machine does not know localhost; /etc/hosts is missing");
    return;
  }
  Server server;
  int64_t utime = 1'000'000;
  const auto link = makeLink(server.link("localhost"));
  CHECK(comesBack(*link, utime));
}

TEST_CASE("a hang-up is noticed at once and the link comes back to a new server") {
  auto server = std::make_unique<Server>();
  const uint16_t port = server->port;
  int64_t utime = 1'000'000;
  const auto link = makeLink(server->link());
  REQUIRE(comesBack(*link, utime));
  server->accept();
  server.reset();
  CHECK(noticesEnd(*link));
  CHECK_FALSE(link->isOpen());
  CHECK_FALSE(link->problem().empty());
  CHECK_FALSE(send(*link, "x"));
  CHECK_FALSE(comesBack(*link, utime));
  CHECK_THAT(link->problem(), Catch::Contains("Connection refused"));
  server = std::make_unique<Server>(port);
  REQUIRE(server->port == port);
  utime += 1'000'000;
  REQUIRE(comesBack(*link, utime));
  CHECK(send(*link, "again"));
  server->accept();
  char heard[8] = {};
  CHECK(::recv(server->client, heard, 5, MSG_WAITALL) == 5);
  CHECK(std::string(heard) == "again");
}

TEST_CASE("a reader that stops reading fills the line, the link never blocks nor splits") {
  Server server;
  int64_t utime = 1'000'000;
  const auto link = makeLink(server.link());
  REQUIRE(comesBack(*link, utime));
  server.accept();
  const std::string command(1000, 'x');
  size_t sent = 0;
  const auto start = std::chrono::steady_clock::now();
  while (sent < 100'000'000 && send(*link, command)) sent += command.size();
  CHECK(sent < 100'000'000);
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(5));
  if (link->isOpen()) return;  // the last command was refused completely
  // Otherwise it was sent partially: the peer sees the line break instead of a partial command.
  size_t heard = 0;
  char buffer[65536];
  ssize_t count = 0;
  while ((count = ::recv(server.client, buffer, sizeof buffer, 0)) > 0)
    heard += static_cast<size_t>(count);
  CHECK(count == -1);
  CHECK(heard <= sent + command.size());
}

TEST_CASE("a host that does not answer is given up after a second of robot time") {
  // TEST-NET-1 has no route; an immediate refusal by the network is also acceptable.
  const auto link = makeLink("tcp:192.0.2.1:9");
  int64_t utime = 1'000'000;
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 300; ++i, utime += 10'000) REQUIRE_FALSE(link->reopen(utime));
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(1));
  CHECK_FALSE(link->problem().empty());
}

TEST_CASE("an unknown host is one clear line") {
  const auto link = makeLink("tcp:no-such-host.invalid:80");
  CHECK_FALSE(link->isOpen());
  CHECK_THAT(link->problem(), Catch::Contains("host no-such-host.invalid is unknown"));
}

}  // namespace tread
