// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <chrono>
#include <thread>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>
#include <lcm/lcm-cpp.hpp>

#include "common/bus/bus.hpp"
#include "common/bus/host_clock.hpp"
#include "common/bus/lcm_bus.hpp"
#include "common/bus/tcp_relay.hpp"
#include "common/messages/blank.hpp"
#include "tests/system/own_bus.hpp"

using namespace tread;

namespace {

class Pinger : public Node {
 public:
  explicit Pinger(Bus& bus) : bus_(bus) {}
  int64_t period() const override { return 5'000; }
  void step(int64_t utime) override {
    mark_t mark{};
    mark.utime = utime;
    mark.seq = steps++;
    bus_.publish(kMark, mark);
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  void shutdown(int64_t /*utime*/) override { shut_down = true; }
  int steps = 0;
  bool shut_down = false;

 private:
  Bus& bus_;
};

/// An in-memory bus that follows the time of MOTOR messages.
struct Follower {
  Follower() {
    bus.subscribe<motor_t>(kMotor, [](const motor_t&) {});
  }
  void hear(const std::vector<int64_t>& utimes) {
    for (const int64_t utime : utimes) {
      motor_t motor{};
      motor.utime = utime;
      bus.publish(kMotor, motor);
    }
    bus.handle(100);
  }
  LcmBus bus{"memq://", TimeSource::kFollow};
};

}  // namespace

TEST_CASE("over real LCM a node steps at its period, is heard, and shuts down cleanly") {
  std::unique_ptr<LcmBus> speaker;
  std::unique_ptr<LcmBus> hearer;
  try {
    const std::string url = tread::testing::ownLcmUrl();
    speaker = std::make_unique<LcmBus>(url, TimeSource::kHost);
    hearer = std::make_unique<LcmBus>(url, TimeSource::kFollow);
  } catch (const std::runtime_error& error) {
    WARN("skipped: " << error.what());
    return;
  }
  int heard = 0;
  hearer->subscribe<mark_t>(kMark, [&](const mark_t&) { ++heard; });
  hearer->handle(0);
  Pinger pinger(*speaker);
  std::atomic<bool> stop{false};
  std::thread runner([&] { speaker->run(pinger, stop); });
  for (int i = 0; i < 400 && heard < 50; ++i) hearer->handle(50);
  stop = true;
  runner.join();
  REQUIRE(heard >= 50);
  REQUIRE(pinger.shut_down);
  const CycleTimes times = speaker->takeCycleTimes();
  REQUIRE(times.mean_us >= 500);
  REQUIRE(times.max_us >= times.mean_us);
  REQUIRE(speaker->takeCycleTimes().max_us == 0);  // counted since the last call
}

TEST_CASE("a process without a device follows the time of the messages") {
  Follower follower;
  const int64_t ahead = follower.bus.now() + 500'000'000'000;
  follower.hear({ahead, ahead + 20'000, ahead + 40'000});
  REQUIRE(follower.bus.now() >= ahead + 40'000);
  REQUIRE(follower.bus.now() < ahead + 60'000'000);
  follower.hear({5});  // an old message does not set time back
  REQUIRE(follower.bus.now() >= ahead + 40'000);
  REQUIRE(follower.bus.statistics().jumps == 0);
}

TEST_CASE("one message from the far future does not move the time of those that follow it") {
  Follower follower;
  const int64_t start = 1'000'000'000;
  follower.hear({start, start + 20'000, start + 40'000});
  for (const int64_t wrong : {start + 3'600'000'000, INT64_MAX, INT64_MIN, int64_t{-1}}) {
    follower.hear({wrong});
    REQUIRE(follower.bus.now() >= start + 40'000);
    REQUIRE(follower.bus.now() < start + 60'000'000);
  }
  REQUIRE(follower.bus.statistics().jumps == 4);
  REQUIRE(follower.bus.statistics().last_refusal.find("MOTOR: utime -1 is not of the present") ==
          0);
  health_t health{};
  follower.bus.subscribe<health_t>(kHealth, [&](const health_t& message) { health = message; });
  HealthReporter(follower.bus, "test", "").step(follower.bus.now());
  follower.bus.handle(100);
  REQUIRE(health.counters.size() == 1);
  REQUIRE(health.counters[0].counter_name == "time jumps refused");
  REQUIRE(health.counters[0].counted == 4);
}

TEST_CASE("a message that may be old by its nature does not tell the time") {
  LcmBus bus("memq://", TimeSource::kFollow);
  bus.subscribe<mark_t>(kMark, [](const mark_t&) {});
  for (int64_t utime = 1'000'000'000; utime < 1'000'000'010; ++utime) {
    mark_t mark{};
    mark.utime = utime;
    bus.publish(kMark, mark);
  }
  bus.handle(100);
  REQUIRE(bus.now() < 900'000'000);
}

TEST_CASE("handlers that never run dry do not keep a node from its steps") {
  class Counting : public Node {
   public:
    explicit Counting(std::atomic<bool>& stop) : stop_(stop) {}
    int64_t period() const override { return 1'000; }
    void step(int64_t /*utime*/) override { stop_ = ++steps == 3; }
    int steps = 0;

   private:
    std::atomic<bool>& stop_;
  };
  LcmBus bus("memq://", TimeSource::kHost);
  std::atomic<bool> stop{false};
  Counting node(stop);
  constexpr int kFlood = 200'000;
  int heard = 0;
  bus.subscribe<mark_t>(kMark, [&](const mark_t& mark) {
    if (++heard < kFlood) bus.publish(kMark, mark);
  });
  bus.publish(kMark, mark_t{});
  bus.run(node, stop);
  REQUIRE(node.steps == 3);
  REQUIRE(heard < kFlood);
}

TEST_CASE("a node that fails in a step makes its outputs safe before the process ends") {
  class Failing : public Node {
   public:
    int64_t period() const override { return 1'000; }
    void step(int64_t /*utime*/) override { throw std::runtime_error("broken"); }
    void shutdown(int64_t /*utime*/) override { shut_down = true; }
    bool shut_down = false;
  };
  LcmBus bus("memq://", TimeSource::kHost);
  Failing node;
  const std::atomic<bool> stop{false};
  REQUIRE_THROWS_WITH(bus.run(node, stop), "broken");
  REQUIRE(node.shut_down);
}

TEST_CASE("an unexpected type over LCM is counted and does not reach the handler") {
  LcmBus bus("memq://", TimeSource::kHost);
  int heard = 0;
  bus.subscribe<ins_t>(kIns, [&](const ins_t&) { ++heard; });
  Channel<goal_t> wrong{{"INS", "goal_t", "test", 0, 0, 1000}};
  bus.publish(wrong, goal_t{});
  bus.handle(100);
  REQUIRE(heard == 0);
  REQUIRE(bus.statistics().undecodable == 1);
}

TEST_CASE("a message above its channel's limit comes over LCM in vain") {
  LcmBus bus("memq://", TimeSource::kHost);
  int heard = 0;
  bus.subscribe<mark_t>(kMark, [&](const mark_t&) { ++heard; });
  Channel<mark_t> generous = kMark;
  generous.max_bytes = 60'000;
  mark_t mark{};
  mark.mark_value = std::string(2'000, 'x');
  REQUIRE(bus.publish(generous, mark));
  bus.publish(kMark, mark_t{});
  bus.handle(100);
  REQUIRE(heard == 1);
  REQUIRE(bus.statistics().refused.at("too large") == 1);
}

TEST_CASE("an LCM that cannot be used is one clear line with the command that mends it") {
  REQUIRE_THROWS_WITH(
      LcmBus("nosuchprovider://", TimeSource::kHost),
      Catch::Contains("LCM cannot use 'nosuchprovider://'") && Catch::Contains("ip route add"));
}

TEST_CASE("without multicast messages go over a relay, each channel to whoever subscribed to it") {
  const TcpRelay relay(0);
  CHECK_THROWS_WITH(TcpRelay(static_cast<uint16_t>(std::stoi(relay.url().substr(17)))),
                    Catch::Contains("cannot be used"));
  LcmBus listener(relay.url(), TimeSource::kHost);
  std::vector<std::string> heard;
  listener.subscribe<mark_t>(kMark, [&](const mark_t& mark) { heard.push_back(mark.mark_value); });
  LcmBus halted(relay.url(), TimeSource::kHost);  // never reads
  halted.subscribe<mark_t>(kMark, [](const mark_t&) {});
  LcmBus speaker(relay.url(), TimeSource::kHost);
  estop_t stop{};
  stop.utime = hostNow();
  mark_t mark{};
  const int64_t started = hostNow();
  for (int i = 0; i < 20000; ++i) {
    mark.utime = hostNow();
    mark.seq = i;
    mark.mark_value = std::string(900, 'x') + std::to_string(i);
    REQUIRE(speaker.publish(kMark, mark));
    if (i % 100 == 0) REQUIRE(speaker.publish(kEstop, stop));
    // Independent of the load: 20 000 delayed acknowledgements would take 800 s.
    while (static_cast<int>(heard.size()) <= i && hostNow() - started < 60'000'000)
      listener.handle(10);
  }
  CHECK(heard.size() == 20000);
  CHECK(listener.statistics().lost == 0);
}

TEST_CASE("who subscribes to no regular expression loses its own connection, not the publisher's") {
  const TcpRelay relay(0);
  lcm::LCM other(relay.url());
  other.subscribeFunction(
      "(?i)mark", +[](const lcm::ReceiveBuffer*, const std::string&, int) {},
      0);  // accepted only by liblcm
  LcmBus listener(relay.url(), TimeSource::kHost);
  int heard = 0;
  listener.subscribe<mark_t>(kMark, [&](const mark_t&) { ++heard; });
  LcmBus speaker(relay.url(), TimeSource::kHost);
  auto mark = blank<mark_t>();
  mark.utime = hostNow();
  for (int i = 0; i < 50 && heard < 3; ++i) {
    mark.seq = i;
    REQUIRE(speaker.publish(kMark, mark));
    listener.handle(20);
  }
  CHECK(heard == 3);
}

TEST_CASE("a channel or a subscription as long as no name ends its client, not the relay") {
  const TcpRelay relay(0);
  LcmBus listener(relay.url(), TimeSource::kHost);
  int heard = 0;
  listener.subscribe<mark_t>(kMark, [&](const mark_t&) { ++heard; });
  lcm::LCM all(relay.url());
  all.subscribeFunction(
      ".*", +[](const lcm::ReceiveBuffer*, const std::string&, int) {}, 0);
  for (const uint32_t type : {1U, 2U}) {  // PUBLISH, SUBSCRIBE
    std::string bytes;
    const std::string name(900'000, type == 1 ? 'M' : '(');
    for (const uint32_t number : {0x287617fbU, 0x0100U, type, static_cast<uint32_t>(name.size())}) {
      const uint32_t big_endian = htonl(number);
      bytes.append(reinterpret_cast<const char*>(&big_endian), sizeof big_endian);
    }
    bytes += name + std::string(4, '\0');
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<uint16_t>(std::stoi(relay.url().substr(17))));
    const int client = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    REQUIRE(connect(client, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0);
    static_cast<void>(send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL));
    shutdown(client, SHUT_WR);
    char answer[64];
    while (recv(client, answer, sizeof answer, 0) > 0) {
    }
    close(client);
  }
  LcmBus speaker(relay.url(), TimeSource::kHost);
  auto mark = blank<mark_t>();
  mark.utime = hostNow();
  for (int i = 0; i < 50 && heard == 0; ++i) {
    mark.seq = i;
    REQUIRE(speaker.publish(kMark, mark));
    listener.handle(20);
  }
  CHECK(heard > 0);
}

TEST_CASE("where no relay runs, that is said") {
  CHECK_THROWS_WITH(LcmBus("tcpq://127.0.0.1:1", TimeSource::kHost),
                    Catch::Contains("no tread-launch with this --lcm-url runs"));
}
