// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Datagrams in LCM's format, sent by hand: which of them reach a process.
#include <catch2/catch.hpp>

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <lcm/lcm-cpp.hpp>

#include "common/bus/host_clock.hpp"
#include "common/bus/lcm_bus.hpp"
#include "common/bus/multicast_only.hpp"
#include "tests/system/own_bus.hpp"

using namespace tread;

namespace {

constexpr const char* kGroup = "239.255.76.67";

/// A mark as LCM's short message: magic, number, zero-terminated channel, message.
std::vector<uint8_t> datagramOf(const std::string& value) {
  mark_t mark{};
  mark.utime = hostNow();
  mark.mark_value = value;
  std::vector<uint8_t> bytes{0x4c, 0x43, 0x30, 0x32, 0, 0, 0, 1};
  for (const char c : std::string("MARK")) bytes.push_back(static_cast<uint8_t>(c));
  bytes.push_back(0);
  const size_t head = bytes.size();
  bytes.resize(head + static_cast<size_t>(mark.getEncodedSize()));
  mark.encode(bytes.data(), static_cast<int>(head), mark.getEncodedSize());
  return bytes;
}

/// A socket of an attacker: plain UDP.
class Sender {
 public:
  Sender() {
    const in_addr loopback{htonl(INADDR_LOOPBACK)};
    REQUIRE(setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback) == 0);
  }
  ~Sender() { close(socket_); }
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;

  void send(const std::string& host, uint16_t port, const std::string& value) const {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    REQUIRE(inet_pton(AF_INET, host.c_str(), &to.sin_addr) == 1);
    const std::vector<uint8_t> bytes = datagramOf(value);
    REQUIRE(sendto(socket_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to),
                   sizeof to) == static_cast<ssize_t>(bytes.size()));
  }

 private:
  int socket_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
};

/// 127.0.0.1 and this host's other addresses.
std::vector<std::string> ownAddresses() {
  std::vector<std::string> found{"127.0.0.1", "127.0.0.2"};
  ifaddrs* list = nullptr;
  REQUIRE(getifaddrs(&list) == 0);
  for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN] = "";
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr, text,
              sizeof text);
    found.emplace_back(text);
  }
  freeifaddrs(list);
  return found;
}

/// Own multicast URL; skips the test if there is no route.
std::string multicastUrlOrSkip() {
  const std::string url = tread::testing::ownLcmUrl();
  if (url.rfind("udpm:", 0) == 0) return url;
  WARN("skipped: there is no multicast route");
  return "";
}

uint16_t portOf(const std::string& url) {
  return static_cast<uint16_t>(std::stoi(url.substr(url.rfind(':') + 1)));
}

/// A bus that collects the values of marks.
struct Hearer {
  explicit Hearer(const std::string& url) : bus(url, TimeSource::kHost) {
    bus.subscribe<mark_t>(kMark, [this](const mark_t& mark) { heard.push_back(mark.mark_value); });
  }
  /// Sends a final message by the group, after which no earlier one can arrive.
  std::vector<std::string> heardUntil(const Sender& sender, uint16_t port,
                                      const std::string& last = "last") {
    sender.send(kGroup, port, last);
    for (int i = 0; i < 500 && (heard.empty() || heard.back() != last); ++i) bus.handle(20);
    return heard;
  }
  LcmBus bus;
  std::vector<std::string> heard;
};

int boundSocket(int type, uint16_t port) {
  const int made = socket(AF_INET, type | SOCK_CLOEXEC, 0);
  const int on = 1;
  setsockopt(made, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(port);
  place.sin_addr.s_addr = htonl(type == SOCK_DGRAM ? INADDR_ANY : INADDR_LOOPBACK);
  REQUIRE(bind(made, reinterpret_cast<const sockaddr*>(&place), sizeof place) == 0);
  return made;
}

bool isLocked(int descriptor) {
  int locked = 0;
  socklen_t size = sizeof locked;
  REQUIRE(getsockopt(descriptor, SOL_SOCKET, SO_LOCK_FILTER, &locked, &size) == 0);
  return locked != 0;
}

/// Sockets of this process that accept only datagrams from links that they have joined on.
int keptToTheirLinks() {
  int kept = 0;
  for (int descriptor = 0; descriptor < 256; ++descriptor) {
    int all = 1;
    socklen_t size = sizeof all;
    if (getsockopt(descriptor, IPPROTO_IP, IP_MULTICAST_ALL, &all, &size) == 0 && all == 0) ++kept;
  }
  return kept;
}

}  // namespace

TEST_CASE(
    "an LCM datagram sent to an address of the host reaches no handler, by the group it does") {
  const std::string url = multicastUrlOrSkip();
  if (url.empty()) return;
  const uint16_t port = portOf(url);
  const Sender sender;
  {
    // LCM alone accepts it, so the test is meaningful.
    lcm::LCM bare(url);
    int heard = 0;
    bare.subscribeFunction(
        "MARK", +[](const lcm::ReceiveBuffer*, const std::string&, int* count) { ++*count; },
        &heard);
    sender.send("127.0.0.1", port, "unicast");
    for (int i = 0; i < 500 && heard == 0; ++i) bare.handleTimeout(20);
    CHECK(heard == 1);
  }
  Hearer hearer(url);
  for (const std::string& address : ownAddresses()) sender.send(address, port, "to " + address);
  CHECK(hearer.heardUntil(sender, port) == std::vector<std::string>{"last"});
}

TEST_CASE("a group that every host has joined is no way in") {
  const std::string url = multicastUrlOrSkip();
  if (url.empty()) return;
  const Sender sender;
  Hearer hearer(url);
  sender.send("224.0.0.1", portOf(url), "to all hosts");
  CHECK(hearer.heardUntil(sender, portOf(url)) == std::vector<std::string>{"last"});
}

TEST_CASE("each bus of a process is closed, and no other socket is touched") {
  const std::string url = multicastUrlOrSkip();
  if (url.empty()) return;
  const uint16_t port = portOf(url);
  const int same_port = boundSocket(SOCK_DGRAM, port);  // as a parent may leave it open
  const int other_port = boundSocket(SOCK_DGRAM, 0);
  const int stream = boundSocket(SOCK_STREAM, port);
  const Sender sender;
  CHECK(keptToTheirLinks() == 0);
  Hearer first(url);
  Hearer second(url);
  CHECK(keptToTheirLinks() == 2);
  sender.send("127.0.0.1", port, "unicast");
  CHECK(first.heardUntil(sender, port) == std::vector<std::string>{"last"});
  CHECK(second.heardUntil(sender, port, "more") == std::vector<std::string>{"last", "more"});
  for (const int unrelated : {same_port, other_port, stream}) {
    CHECK_FALSE(isLocked(unrelated));
    close(unrelated);
  }
}

TEST_CASE("where LCM's socket cannot be closed to others, a process does not start") {
  const std::string url = multicastUrlOrSkip();
  if (url.empty()) return;
  // LCM reads a port as octal, too: its socket would be elsewhere.
  CHECK_THROWS_WITH(LcmBus("udpm://239.255.76.67:02345?ttl=0", TimeSource::kHost),
                    Catch::Contains("LCM's socket is not found") &&
                        Catch::Contains("this process does not start"));
  // It exists already; whether this is LCM's is unknown.
  lcm::LCM running(url);
  REQUIRE(running.getFileno() >= 0);
  CHECK_THROWS_WITH(openForMulticastOnly(running, url), Catch::Contains("is not found"));
  CHECK_NOTHROW(LcmBus("memq://", TimeSource::kHost));
}
