// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <catch2/catch.hpp>

#include "common/link/make_link.hpp"
#include "link_helpers.hpp"

namespace tread {
namespace {

sockaddr_in loopback(uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

/// A socket on a port chosen by the system.
struct Sender {
  Sender() {
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    ::bind(fd, reinterpret_cast<const sockaddr*>(&address), size);
    ::getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
    port = ntohs(address.sin_port);
  }
  ~Sender() { ::close(fd); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  void sendTo(uint16_t to, const std::string& text) const {
    const sockaddr_in address = loopback(to);
    ::sendto(fd, text.data(), text.size(), 0, reinterpret_cast<const sockaddr*>(&address),
             sizeof address);
  }

  int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  uint16_t port = 0;
};

uint16_t freePort() {
  return Sender().port;
}

}  // namespace

TEST_CASE("datagrams become one stream, whole even through a short buffer, and none ends it") {
  const uint16_t port = freePort();
  const auto link = makeLink("udp:127.0.0.1:" + std::to_string(port));
  REQUIRE(link->isOpen());
  CHECK(link->descriptor() >= 0);
  const Sender sender;
  sender.sendTo(port, "$GPGGA,1\n");
  sender.sendTo(port, "");
  sender.sendTo(port, "$GPGGA,2\n");
  std::string text;
  for (int i = 0; i < 5000 && text.size() < 18; ++i) {
    uint8_t four[4];
    const auto count = link->read(four, sizeof four);
    REQUIRE(count);
    text.append(reinterpret_cast<const char*>(four), *count);
    if (*count == 0) ::usleep(200);
  }
  CHECK(text == "$GPGGA,1\n$GPGGA,2\n");
  CHECK_FALSE(testing::send(*link, "it listens only"));
}

TEST_CASE("a port in use is said, and taken when it is free") {
  auto taken = std::make_unique<Sender>();
  const auto link = makeLink("udp:127.0.0.1:" + std::to_string(taken->port));
  CHECK_FALSE(link->isOpen());
  CHECK_THAT(link->problem(), Catch::Contains("Address already in use"));
  taken.reset();
  CHECK(link->reopen(1'000'000));
}

TEST_CASE("a host that is no number is said") {
  const auto link = makeLink("udp:localhost:5000");
  CHECK_THAT(link->problem(), Catch::Contains("no IPv4 number"));
}

}  // namespace tread
