// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/system/own_bus.hpp"

#include <memory>
#include <vector>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include "common/bus/tcp_relay.hpp"

namespace tread::testing {
namespace {

bool multicastHasRoute() {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(7667);
  inet_pton(AF_INET, "239.255.76.67", &address.sin_addr);
  const int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int answer =
      connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address);
  close(descriptor);
  return answer == 0;
}

int ownPort() {
  static int count = 0;
  return 20000 + (getpid() * 7 + count++) % 20000;
}

std::string multicastUrl() {
  return "udpm://239.255.76.67:" + std::to_string(ownPort()) + "?ttl=0";
}

}  // namespace

std::string ownLcmUrl() {
  static std::vector<std::unique_ptr<TcpRelay>> relays;
  if (multicastHasRoute()) return multicastUrl();
  relays.push_back(std::make_unique<TcpRelay>(0));
  return relays.back()->url() + "?ttl=0";
}

std::string launchedLcmUrl() {
  if (multicastHasRoute()) return multicastUrl();
  return "tcpq://127.0.0.1:" + std::to_string(ownPort()) + "?ttl=0";
}

}  // namespace tread::testing
