// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/bus/bus.hpp"
#include "common/bus/virtual_bus.hpp"

using namespace tread;

namespace {

/// Publishes a mark at each step and counts received marks.
class Clock : public Node {
 public:
  Clock(Bus& bus, int64_t period) : bus_(bus), period_(period) {}
  int64_t period() const override { return period_; }
  void step(int64_t utime) override {
    steps.push_back(utime);
    mark_t mark{};
    mark.utime = utime;
    mark.seq = seq_++;
    mark.mark_kind = "note";
    bus_.publish(kMark, mark);
  }
  std::vector<int64_t> steps;

 private:
  Bus& bus_;
  int64_t period_;
  int64_t seq_ = 0;
};

class Listener : public Node {
 public:
  explicit Listener(Bus& bus) {
    bus.subscribe<mark_t>(kMark, [this, &bus](const mark_t& mark) {
      heard.push_back(mark.seq);
      times.push_back(bus.now());
    });
  }
  int64_t period() const override { return 1'000'000; }
  void step(int64_t /*utime*/) override {}
  std::vector<int64_t> heard;
  std::vector<int64_t> times;
};

struct Run {
  std::vector<int64_t> heard;
  std::vector<std::vector<uint8_t>> bytes;
};

Run runWith(const FaultPlan& faults, uint64_t seed) {
  Run run;
  VirtualBus bus(seed, faults);
  bus.setTap([&](int64_t, const char*, const uint8_t* bytes, size_t size) {
    run.bytes.emplace_back(bytes, bytes + size);
  });
  bus.addNode("clock", [](Bus& end) { return std::make_unique<Clock>(end, 10'000); });
  bus.addNode("listener", [](Bus& end) { return std::make_unique<Listener>(end); });
  bus.runUntil(bus.now() + 10'000'000);
  run.heard = static_cast<Listener*>(bus.node("listener"))->heard;
  return run;
}

}  // namespace

TEST_CASE("a virtual bus delivers every message in order when nothing is wrong") {
  const Run run = runWith({}, 1);
  REQUIRE(run.heard.size() == 1000);
  for (size_t i = 0; i < run.heard.size(); ++i) REQUIRE(run.heard[i] == static_cast<int64_t>(i));
}

TEST_CASE("the same seed gives the same faults, another seed others") {
  FaultPlan faults;
  MessageFault fault;
  fault.drop = 0.2;
  fault.reorder = 0.1;
  fault.duplicate = 0.05;
  faults.messages.push_back(fault);
  const Run first = runWith(faults, 7);
  REQUIRE(first.heard == runWith(faults, 7).heard);
  REQUIRE(first.bytes == runWith(faults, 7).bytes);
  REQUIRE(first.heard != runWith(faults, 8).heard);
  REQUIRE(first.heard.size() > 700);
  REQUIRE(first.heard.size() < 950);
  REQUIRE_FALSE(std::is_sorted(first.heard.begin(), first.heard.end()));
}

TEST_CASE("a node's compute time delays what it publishes and lets its missed steps go") {
  VirtualBus bus(1);
  NodeTiming timing;
  timing.compute_us = 15'000;
  bus.addNode(
      "clock", [](Bus& end) { return std::make_unique<Clock>(end, 10'000); }, timing);
  bus.addNode("listener", [](Bus& end) { return std::make_unique<Listener>(end); });
  const int64_t start = bus.now();
  bus.runUntil(start + 1'000'000);
  const auto* listener = static_cast<Listener*>(bus.node("listener"));
  REQUIRE(listener->times.front() >= start + 15'000);
  REQUIRE(listener->times.front() < start + 16'000);
  const auto* clock = static_cast<Clock*>(bus.node("clock"));
  REQUIRE(clock->steps.size() >= 60);
  REQUIRE(clock->steps.size() <= 67);
}

TEST_CASE("a hung node does nothing for a while, then hears what was sent to it meanwhile") {
  VirtualBus bus(1);
  bus.addNode("clock", [](Bus& end) { return std::make_unique<Clock>(end, 10'000); });
  bus.addNode("listener", [](Bus& end) { return std::make_unique<Listener>(end); });
  std::vector<std::string> receivers;
  bus.setArrivalTap([&](int64_t, const std::string& receiver, const char*, const uint8_t*, size_t) {
    receivers.push_back(receiver);
  });
  const auto* clock = static_cast<Clock*>(bus.node("clock"));
  const auto* listener = static_cast<Listener*>(bus.node("listener"));
  bus.runUntil(bus.now() + 100'000);
  const size_t steps = clock->steps.size(), heard = listener->heard.size();
  REQUIRE(heard > 0);
  CHECK(receivers == std::vector<std::string>(heard, "listener"));
  bus.hang("listener", 300'000);
  bus.runUntil(bus.now() + 200'000);
  CHECK(listener->heard.size() == heard);
  CHECK(clock->steps.size() == steps + 20);
  bus.runUntil(bus.now() + 110'000);
  CHECK(listener->heard.size() >= heard + 30);
  bus.hang("clock", 300'000);
  const size_t before = clock->steps.size();
  bus.runUntil(bus.now() + 299'000);
  CHECK(clock->steps.size() == before);
  bus.runUntil(bus.now() + 20'000);
  CHECK(clock->steps.size() > before);
}

TEST_CASE("a killed node is silent, its unsent messages are lost, and a restart builds it anew") {
  FaultPlan faults;
  faults.nodes.push_back({"clock", 2'000'000, 1'000'000});
  VirtualBus bus(1, faults);
  bus.addNode("clock", [](Bus& end) { return std::make_unique<Clock>(end, 10'000); });
  bus.addNode("listener", [](Bus& end) { return std::make_unique<Listener>(end); });
  const int64_t start = bus.now();
  bus.runUntil(start + 2'500'000);
  REQUIRE(bus.node("clock") == nullptr);
  auto* listener = static_cast<Listener*>(bus.node("listener"));
  const size_t before = listener->heard.size();
  REQUIRE(before == 200);
  bus.runUntil(start + 4'000'000);
  REQUIRE(bus.node("clock") != nullptr);
  REQUIRE(listener->heard.size() > before + 90);
  REQUIRE(listener->heard[before] == 0);
  REQUIRE(bus.node("clock") != nullptr);
}

TEST_CASE(
    "messages of an unexpected type and corrupted ones are counted, told in one line, and harm "
    "nobody") {
  VirtualBus bus(1);
  bus.addNode("listener", [](Bus& end) { return std::make_unique<Listener>(end); });
  goal_t goal{};
  goal.goal_id = 3;
  std::vector<uint8_t> bytes(static_cast<size_t>(goal.getEncodedSize()));
  goal.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  bus.inject("MARK", bytes.data(), bytes.size());
  bus.inject("MARK", bytes.data(), 3);
  bus.inject("MARK", nullptr, 0);
  bus.runUntil(bus.now() + 1000);
  REQUIRE(bus.statistics("listener").undecodable == 3);
  REQUIRE(bus.statistics("listener").received == 0);
  REQUIRE(
      bus.statistics("listener").last_refusal.find("MARK: a message of 0 bytes is not a mark_t") ==
      0);
}

TEST_CASE("trailing bytes and negative lengths are refused") {
  VirtualBus bus(1);
  int heard = 0;
  bus.outside().subscribe<scan_t>(kScan, [&](const scan_t&) { ++heard; });
  scan_t scan{};
  std::vector<uint8_t> bytes(static_cast<size_t>(scan.getEncodedSize()));
  scan.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  bus.inject("SCAN", bytes.data(), bytes.size());
  bytes.push_back(0);
  bus.inject("SCAN", bytes.data(), bytes.size());
  bytes.pop_back();
  // num_beams and num_points are the last two fields of an empty scan.
  for (size_t i = bytes.size() - 8; i < bytes.size(); ++i) bytes[i] = 0xff;
  bus.inject("SCAN", bytes.data(), bytes.size());
  bus.runUntil(bus.now() + 1000);
  REQUIRE(heard == 1);
  REQUIRE(bus.outside().statistics().undecodable == 2);
}

TEST_CASE("a handler that throws is counted and the bus goes on") {
  VirtualBus bus(1);
  int heard = 0;
  bus.outside().subscribe<mark_t>(kMark, [&](const mark_t&) {
    ++heard;
    throw std::runtime_error("no");
  });
  mark_t mark{};
  bus.outside().publish(kMark, mark);
  bus.outside().publish(kMark, mark);
  bus.runUntil(bus.now() + 1000);
  REQUIRE(heard == 2);
  REQUIRE(bus.outside().statistics().failed == 2);
}

TEST_CASE("a handler may subscribe while it runs") {
  VirtualBus bus(1);
  int heard = 0;
  int subscribed = 0;
  bus.outside().subscribe<mark_t>(kMark, [&](const mark_t&) {
    for (; subscribed < 20; ++subscribed)
      bus.outside().subscribe<mark_t>(kMark, [&heard](const mark_t&) { ++heard; });
  });
  bus.outside().publish(kMark, mark_t{});
  bus.runUntil(bus.now() + 1000);
  REQUIRE(heard == 20);
}

TEST_CASE("a message above its channel's limit is not sent and its publisher is told") {
  VirtualBus bus(1);
  arm_t arm{};
  arm.arm_reason = std::string(2000, 'x');
  REQUIRE_FALSE(bus.outside().publish(kArm, arm));
  REQUIRE(bus.outside().statistics().oversized == 1);
}

TEST_CASE("a message above its channel's limit is not taken, whoever sends it, and is counted") {
  VirtualBus bus(1);
  int heard = 0;
  int beside = 0;
  bus.outside().subscribe<arm_t>(kArm, [&](const arm_t&) { ++heard; });
  bus.outside().overhear<health_t>(kHealth, [&](const health_t&) { ++beside; });
  const auto inject = [&](const auto& channel, const auto& message) {
    std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    // The largest message may have a seal in addition.
    const size_t size = static_cast<size_t>(channel.max_bytes) + kSealBytes + 1;
    bytes.resize(std::max(bytes.size(), size));
    bus.inject(channel.name, bytes.data(), bytes.size());
    bus.runUntil(bus.now() + 1'000);
  };
  arm_t arm{};
  arm.armed = true;
  arm.arm_reason = std::string(2'000, 'x');
  inject(kArm, arm);
  health_t health{};
  health.process = std::string(9'000, 'x');
  inject(kHealth, health);
  CHECK(heard == 0);
  CHECK(beside == 0);
  arm.armed = false;  // anybody may disarm
  inject(kArm, arm);
  CHECK(heard == 1);
  const BusStatistics& counted = bus.outside().statistics();
  CHECK(counted.refused.at("too large") == 1);
  CHECK(counted.undecodable == 0);
  CHECK_THAT(counted.last_refusal, Catch::StartsWith("ARM: a message refused: too large; 2"));
}

TEST_CASE("losses are counted by seq, a publisher that starts again is no loss") {
  VirtualBus bus(1);
  bus.outside().subscribe<motor_t>(kMotor, [](const motor_t&) {});
  for (const int64_t seq : {5, 6, 9, 0, 1}) {
    motor_t motor{};
    motor.utime = bus.now();
    motor.seq = seq;
    bus.outside().publish(kMotor, motor);
  }
  bus.runUntil(bus.now() + 1000);
  REQUIRE(bus.outside().statistics().received == 5);
  REQUIRE(bus.outside().statistics().newest.channel == "MOTOR");
  REQUIRE(bus.outside().statistics().newest.seq == 1);
  REQUIRE(bus.outside().statistics().lost == 2);
}

TEST_CASE("messages that overtake each other are no loss") {
  VirtualBus bus(1);
  bus.outside().subscribe<motor_t>(kMotor, [](const motor_t&) {});
  for (const int64_t seq : {5, 7, 6, 8, 8, 10, 11, 9, 12}) {
    motor_t motor{};
    motor.utime = seq * 20'000;
    motor.seq = seq;
    bus.outside().publish(kMotor, motor);
  }
  bus.runUntil(bus.now() + 1000);
  REQUIRE(bus.outside().statistics().received == 9);
  REQUIRE(bus.outside().statistics().lost == 0);
}

TEST_CASE("a publisher of old truths that starts again is not taken for late messages") {
  VirtualBus bus(1);
  bus.outside().subscribe<map_tile_t>(kMap, [](const map_tile_t&) {});
  for (const int64_t seq : {100, 102, 0, 1, 2}) {
    map_tile_t tile{};
    tile.utime = seq * 20'000;
    tile.seq = seq;
    bus.outside().publish(kMap, tile);
  }
  bus.runUntil(bus.now() + 1000);
  REQUIRE(bus.outside().statistics().lost == 1);
}

TEST_CASE("a mailbox keeps the newest message and knows its age") {
  VirtualBus bus(1);
  Latest<mark_t> mark(bus.outside(), kMark);
  REQUIRE_FALSE(mark.any());
  REQUIRE(mark.age(bus.now()) == INT64_MAX);
  mark_t message{};
  message.mark_value = "one";
  bus.outside().publish(kMark, message);
  message.mark_value = "two";
  bus.outside().publish(kMark, message);
  bus.runUntil(bus.now() + 250'000);
  REQUIRE(mark.count() == 2);
  REQUIRE(mark.message().mark_value == "two");
  REQUIRE(mark.age(bus.now()) == 250'000);
}

TEST_CASE("two processes of one name see each other in HEALTH, and neither counts it as an input") {
  class Watching : public Node {
   public:
    explicit Watching(Bus& bus) : health_(bus, "planner", "") { health_.watchNamesakes(); }
    int64_t period() const override { return 100'000; }
    void step(int64_t utime) override { health_.step(utime); }

   private:
    HealthReporter health_;
  };
  VirtualBus bus(1);
  std::map<int64_t, health_t> health;
  bus.outside().subscribe<health_t>(kHealth, [&](const health_t& m) { health[m.boot_id] = m; });
  const auto make = [](Bus& end) { return std::make_unique<Watching>(end); };
  bus.addNode("one", make);
  bus.runUntil(bus.now() + 10'000'000);
  REQUIRE(health.size() == 1);
  CHECK(health.begin()->second.health_state == health_t::HEALTH_OK);
  bus.addNode("two", make);
  bus.runUntil(bus.now() + 3'000'000);
  REQUIRE(health.size() == 2);
  for (const auto& [boot_id, message] : health) {
    CHECK(message.health_state == health_t::HEALTH_DEGRADED);
    CHECK(message.health_reason.find("two processes planner run") == 0);
    CHECK(message.received == 0);
  }
  bus.kill("two");
  bus.runUntil(bus.now() + 5'000'000);
  CHECK(health.begin()->second.health_state == health_t::HEALTH_OK);
}

TEST_CASE("HEALTH comes at 1 Hz and CONFIG at the start and every 10 s") {
  class Reporting : public Node {
   public:
    explicit Reporting(Bus& bus) : health_(bus, "reporting", "lease: 0.2\n") {}
    int64_t period() const override { return 100'000; }
    void step(int64_t utime) override {
      health_.addToCounter("steps");
      health_.step(utime);
    }

   private:
    HealthReporter health_;
  };
  VirtualBus bus(1);
  std::vector<health_t> health;
  int configs = 0;
  bus.outside().subscribe<health_t>(kHealth, [&](const health_t& m) { health.push_back(m); });
  bus.outside().subscribe<config_t>(kConfig, [&](const config_t& m) {
    REQUIRE(m.config_text == "lease: 0.2\n");
    ++configs;
  });
  bus.addNode("reporting", [](Bus& end) { return std::make_unique<Reporting>(end); });
  bus.runUntil(bus.now() + 20'050'000);
  REQUIRE(health.size() == 21);
  REQUIRE(configs == 3);
  REQUIRE(health.back().counters.at(0).counter_name == "steps");
  REQUIRE(health.back().counters.at(0).counted == 201);
  REQUIRE(health.back().process == "reporting");
}

TEST_CASE("HEALTH is sent however many reasons there are to count, and counts them all") {
  class Refusing : public Node {
   public:
    explicit Refusing(Bus& bus) : health_(bus, "refusing", "") {}
    int64_t period() const override { return 10'000; }
    void step(int64_t utime) override {
      health_.addToCounter("refused: " + std::to_string(utime) + std::string(300, 'x'));
      health_.setState(health_t::HEALTH_DEGRADED, std::string(20'000, 'y'));
      health_.step(utime);
    }

   private:
    HealthReporter health_;
  };
  VirtualBus bus(1, {});
  health_t health;
  int heard = 0;
  bus.outside().subscribe<health_t>(kHealth, [&](const health_t& message) {
    health = message;
    ++heard;
  });
  bus.addNode("refusing", [](Bus& end) { return std::make_unique<Refusing>(end); });
  bus.runUntil(bus.now() + 10'000'000);
  CHECK(heard >= 9);
  CHECK(health.num_counters == 51);
  int64_t counted = 0;
  for (const counter_t& counter : health.counters) counted += counter.counted;
  CHECK(counted > 800);
}
