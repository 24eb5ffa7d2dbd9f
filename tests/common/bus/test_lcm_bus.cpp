// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <unistd.h>

#include <thread>

#include "common/bus/lcm_bus.hpp"

using namespace tread;

namespace {

/// A port of its own per test process: with LCM 1.3.1 only the port separates buses (lcm.md, row
/// 8).
std::string ownUrl() {
  return "udpm://239.255.76.67:" + std::to_string(20000 + getpid() % 20000) + "?ttl=0";
}

class Pinger : public Node {
 public:
  explicit Pinger(Bus& bus) : bus_(bus) {}
  int64_t period() const override { return 5'000; }
  void step(int64_t utime) override {
    mark_t mark{};
    mark.utime = utime;
    mark.seq = steps++;
    bus_.publish(kMark, mark);
  }
  void shutdown(int64_t /*utime*/) override { shut_down = true; }
  int steps = 0;
  bool shut_down = false;

 private:
  Bus& bus_;
};

}  // namespace

TEST_CASE("over real LCM a node steps at its period, is heard, and shuts down cleanly") {
  std::unique_ptr<LcmBus> speaker;
  std::unique_ptr<LcmBus> hearer;
  try {
    speaker = std::make_unique<LcmBus>(ownUrl(), TimeSource::kHost);
    hearer = std::make_unique<LcmBus>(ownUrl(), TimeSource::kFollow);
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
  REQUIRE(speaker->takeCycleTimes().max_us >= 0);
}

TEST_CASE("a process without a device follows the time of the messages") {
  LcmBus bus("memq://", TimeSource::kFollow);
  bus.subscribe<mark_t>(kMark, [](const mark_t&) {});
  const int64_t ahead = bus.now() + 500'000'000'000;
  mark_t mark{};
  mark.utime = ahead;
  bus.publish(kMark, mark);
  bus.handle(100);
  REQUIRE(bus.now() >= ahead);
  REQUIRE(bus.now() < ahead + 60'000'000);
  mark.utime = 5;  // an old message does not turn time back
  bus.publish(kMark, mark);
  bus.handle(100);
  REQUIRE(bus.now() >= ahead);
}

TEST_CASE("a foreign type over LCM is counted and does not reach the handler") {
  LcmBus bus("memq://", TimeSource::kHost);
  int heard = 0;
  bus.subscribe<ins_t>(kIns, [&](const ins_t&) { ++heard; });
  Channel<goal_t> wrong{{"INS", "goal_t", "test", 0, 0, 1000}};
  bus.publish(wrong, goal_t{});
  bus.handle(100);
  REQUIRE(heard == 0);
  REQUIRE(bus.statistics().undecodable == 1);
}

TEST_CASE("an LCM that cannot be used is one clear line with the command that mends it") {
  REQUIRE_THROWS_WITH(
      LcmBus("nosuchprovider://", TimeSource::kHost),
      Catch::Contains("LCM cannot use 'nosuchprovider://'") && Catch::Contains("ip route add"));
}
