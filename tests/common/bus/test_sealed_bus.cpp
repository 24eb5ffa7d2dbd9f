// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <unistd.h>

#include "common/bus/bus.hpp"
#include "common/bus/lcm_bus.hpp"
#include "common/bus/virtual_bus.hpp"
#include "common/seal/key_file.hpp"

using namespace tread;

namespace {

struct Wire {
  std::string channel;
  std::vector<uint8_t> bytes;
};

template <class Message>
Wire unsealed(const Channel<Message>& channel, const Message& message) {
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  return {channel.name, bytes};
}

/// Counts received messages, MARK by two handlers, and publishes HEALTH.
class Hearing : public Node {
 public:
  explicit Hearing(Bus& bus) : health_(bus, "hearing", "") {
    bus.subscribe<mark_t>(kMark, [this](const mark_t&) { ++marks; });
    bus.subscribe<mark_t>(kMark, [this](const mark_t&) { ++marks_again; });
    bus.subscribe<estop_t>(kEstop, [this](const estop_t&) { ++stops; });
    bus.subscribe<arm_t>(kArm, [this](const arm_t&) { ++arms; });
    bus.subscribe<goal_t>(kGoal, [this](const goal_t&) { ++goals; });
  }
  int64_t period() const override { return 100'000; }
  void step(int64_t utime) override { health_.step(utime); }
  int marks = 0, marks_again = 0, stops = 0, arms = 0, goals = 0;

 private:
  HealthReporter health_;
};

/// A bus with a key, an operator outside, and a recorder of all messages.
struct SealedBus {
  explicit SealedBus(const FaultPlan& faults = {}) : bus(1, faults) {
    SealKey key;
    key.bytes.fill(9);
    bus.useKey(key);
    bus.outside().subscribe<health_t>(kHealth, [this](const health_t& m) { health = m; });
    bus.setTap([this](int64_t, const char* channel, const uint8_t* bytes, size_t size) {
      wire.push_back({channel, {bytes, bytes + size}});
    });
    bus.addNode("hearing", [](Bus& end) { return std::make_unique<Hearing>(end); });
  }
  Hearing& node() { return *static_cast<Hearing*>(bus.node("hearing")); }
  void run(int64_t us) { bus.runUntil(bus.now() + us); }
  void inject(const Wire& message) {
    bus.inject(message.channel.c_str(), message.bytes.data(), message.bytes.size());
    run(1'000);
  }
  Wire mark() {
    mark_t mark{};
    mark.utime = bus.now();
    REQUIRE(bus.outside().publish(kMark, mark));
    run(1'000);
    return last("MARK");
  }
  Wire last(const std::string& channel) const {
    const auto found = std::find_if(wire.rbegin(), wire.rend(), [&](const Wire& message) {
      return message.channel == channel;
    });
    REQUIRE(found != wire.rend());
    return *found;
  }
  int64_t refused(const std::string& why) {
    const auto& counts = bus.statistics("hearing").refused;
    return counts.count(why) > 0 ? counts.at(why) : 0;
  }
  VirtualBus bus;
  health_t health{};
  std::vector<Wire> wire;
};

}  // namespace

TEST_CASE("with a key a sealed message reaches every handler of its channel, once") {
  SealedBus sealed;
  const Wire message = sealed.mark();
  CHECK(message.bytes.size() == unsealed(kMark, mark_t{}).bytes.size() + kSealBytes);
  CHECK(sealed.node().marks == 1);
  CHECK(sealed.node().marks_again == 1);
  sealed.inject(message);
  CHECK(sealed.node().marks == 1);
  CHECK(sealed.refused("replayed") == 1);
  CHECK(sealed.bus.statistics("hearing").last_refusal ==
        "MARK: a message refused: replayed; it was recorded, or delayed in transit");
}

TEST_CASE("with a key what is forged, changed, moved or held up is refused, counted and told") {
  SealedBus sealed;
  mark_t mark{};
  mark.utime = sealed.bus.now();
  sealed.inject(unsealed(kMark, mark));
  Wire message = sealed.mark();
  Wire changed = message;
  changed.bytes[20] ^= 1;
  sealed.inject(changed);
  sealed.inject({"ARM", message.bytes});
  sealed.run(2'000'000);
  sealed.inject(message);
  CHECK(sealed.node().marks == 1);
  CHECK(sealed.node().arms == 0);
  CHECK(sealed.refused("unsealed") == 1);
  CHECK(sealed.refused("wrong tag") == 2);
  CHECK(sealed.refused("too old") == 1);
  CHECK(sealed.bus.statistics("hearing").undecodable == 0);
  sealed.run(1'000'000);
  std::map<std::string, int64_t> told;
  for (const counter_t& counter : sealed.health.counters)
    told[counter.counter_name] = counter.counted;
  CHECK(told["refused: unsealed"] == 1);
  CHECK(told["refused: wrong tag"] == 2);
  CHECK(told["refused: too old"] == 1);
  CHECK_THAT(sealed.health.health_reason, Catch::StartsWith("MARK: a message refused: too old"));
}

TEST_CASE("a recorded message does nothing to a process that starts again") {
  SealedBus sealed;
  const Wire message = sealed.mark();
  sealed.bus.restart("hearing");
  sealed.inject(message);
  CHECK(sealed.node().marks == 0);
  CHECK(sealed.refused("too old") == 1);
}

TEST_CASE(
    "stopping is open to everybody: ESTOP, disarming and no goal, and nothing else of theirs") {
  SealedBus sealed;
  estop_t estop{};
  arm_t arm{};
  goal_t goal{};
  estop.utime = arm.utime = goal.utime = sealed.bus.now();
  estop.engaged = 1;
  sealed.inject(unsealed(kEstop, estop));
  sealed.inject(unsealed(kArm, arm));
  sealed.inject(unsealed(kGoal, goal));
  CHECK(sealed.node().stops == 1);
  CHECK(sealed.node().arms == 1);
  CHECK(sealed.node().goals == 1);
  CHECK(sealed.bus.statistics("hearing").refused.empty());
  estop.engaged = 0;
  arm.armed = 1;
  goal.goal_id = 1;
  sealed.inject(unsealed(kEstop, estop));
  sealed.inject(unsealed(kArm, arm));
  sealed.inject(unsealed(kGoal, goal));
  CHECK(sealed.node().stops == 1);
  CHECK(sealed.node().arms == 1);
  CHECK(sealed.node().goals == 1);
  CHECK(sealed.refused("unsealed") == 3);
}

TEST_CASE("a stop with a broken seal stops, too, and a repeated one again") {
  SealedBus sealed;
  estop_t estop{};
  estop.utime = sealed.bus.now();
  estop.engaged = 1;
  REQUIRE(sealed.bus.outside().publish(kEstop, estop));
  sealed.run(1'000);
  Wire message = sealed.last("ESTOP");
  sealed.inject(message);
  message.bytes.back() ^= 1;
  sealed.inject(message);
  CHECK(sealed.node().stops == 3);
}

TEST_CASE("messages that fail on their way are refused, and the others go on") {
  FaultPlan faults;
  MessageFault fault;
  fault.channel = "MARK";
  fault.duplicate = 0.3;
  fault.corrupt = 0.2;
  faults.messages.push_back(fault);
  SealedBus sealed(faults);
  for (int i = 0; i < 1000; ++i) sealed.mark();
  CHECK(sealed.node().marks > 700);
  CHECK(sealed.node().marks + sealed.refused("wrong tag") + sealed.refused("unsealed") +
            sealed.refused("replayed") >
        1250);
  CHECK(sealed.bus.statistics("hearing").undecodable == 0);
}

TEST_CASE("without a key sealed messages are read as if there were no seal") {
  SealedBus sealed;
  const Wire message = sealed.mark();
  VirtualBus open(1);
  int marks = 0;
  open.outside().subscribe<mark_t>(kMark, [&](const mark_t&) { ++marks; });
  open.inject("MARK", message.bytes.data(), message.bytes.size());
  open.runUntil(open.now() + 1'000);
  CHECK(marks == 1);
}

namespace {

/// A program on another host, whose clock started at another time.
class DistantBus : public Bus {
 public:
  DistantBus(SealedBus& robot, int64_t ahead) : robot_(robot), ahead_(ahead) {
    SealKey key;
    key.bytes.fill(9);
    setSealer(Sealer(key, 4711, std::nullopt));
    subscribe<health_t>(kHealth, [this](const health_t&) { ++heard; });
  }
  int64_t now() const override { return robot_.bus.now() + ahead_; }
  int64_t bootId() const override { return 1; }
  void hear(const Wire& wire) { receive(wire.channel, wire.bytes.data(), wire.bytes.size()); }
  int heard = 0;

 protected:
  bool send(const char* channel, const uint8_t* bytes, size_t size) override {
    robot_.inject({channel, {bytes, bytes + size}});
    return true;
  }
  void listen(const char* /*channel*/) override {}

 private:
  SealedBus& robot_;
  int64_t ahead_;
};

}  // namespace

TEST_CASE("an operator at another host takes over session and clock, and is taken at its word") {
  for (const int64_t ahead : {-900'000'000LL, 0LL, 3'600'000'000LL}) {
    SealedBus robot;
    DistantBus station(robot, ahead);
    mark_t mark{};
    CHECK(station.publish(kMark, mark));
    CHECK(robot.refused("unsealed") == 1);
    robot.run(1'000'000);
    const Wire held_up = robot.last("HEALTH");
    robot.run(1'300'000);
    // The first received message was delayed for long, and is later repeated by an attacker.
    station.hear(held_up);
    station.hear(robot.last("HEALTH"));
    station.hear(held_up);
    robot.run(1'000'000);
    station.hear(robot.last("HEALTH"));
    CHECK(station.heard == 2);
    for (int i = 0; i < 3; ++i) station.publish(kMark, mark);
    CHECK(robot.node().marks == 3);
    robot.inject(robot.last("MARK"));
    CHECK(robot.node().marks == 3);
  }
}

TEST_CASE("a recording from before the robot's last start takes no operator in for long") {
  SealedBus robot;
  DistantBus station(robot, 500'000);
  SealKey key;
  key.bytes.fill(9);
  Sealer before_its_start(key, 77, 99);
  const auto recorded = [&](int64_t utime) {
    Wire wire = robot.last("HEALTH");
    wire.bytes.resize(wire.bytes.size() - kSealBytes);
    before_its_start.seal("HEALTH", wire.bytes, utime);
    return wire;
  };
  robot.run(1'100'000);
  station.hear(recorded(900'000'000));
  REQUIRE(station.heard == 1);
  // While both are received the true one is unknown.
  robot.run(700'000);
  station.hear(robot.last("HEALTH"));
  CHECK(station.heard == 1);
  CHECK(station.hearsTwoSessions());
  robot.run(1'300'000);
  station.hear(robot.last("HEALTH"));
  CHECK(station.heard == 2);
  CHECK_FALSE(station.hearsTwoSessions());
  mark_t mark{};
  station.publish(kMark, mark);
  CHECK(robot.node().marks == 1);
  // A replay does not affect the robot that is received.
  for (int i = 0; i < 5; ++i) {
    station.hear(recorded(901'000'000 + i));
    CHECK(station.hearsTwoSessions());
    robot.run(1'000'000);
    station.hear(robot.last("HEALTH"));
    CHECK(station.heard == 3 + i);
  }
}

TEST_CASE("a message as large as its channel allows is sealed, and fits into a datagram") {
  for (const ChannelSpec& channel : kChannels)
    CHECK(static_cast<size_t>(channel.max_bytes) + kSealBytes + sizeof "LEARNER_STATE" <= 65499);
  SealedBus sealed;
  mark_t mark{};
  mark.utime = sealed.bus.now();
  while (mark.getEncodedSize() < kMark.max_bytes) mark.mark_value += 'x';
  REQUIRE(sealed.bus.outside().publish(kMark, mark));
  sealed.run(1'000);
  CHECK(sealed.node().marks == 1);
  mark.mark_value += 'x';
  CHECK_FALSE(sealed.bus.outside().publish(kMark, mark));
}

TEST_CASE("a process that follows the messages' time takes sealed ones from its start on") {
  const std::string path = "seal_bus_" + std::to_string(getpid()) + ".key";
  writeNewKey(path);
  LcmBus bus(BusAccess{"memq://", hostSealer(path)}, TimeSource::kFollow);
  std::filesystem::remove(path);
  int marks = 0;
  bus.subscribe<mark_t>(kMark, [&](const mark_t&) { ++marks; });
  for (int i = 0; i < 10; ++i) bus.publish(kMark, mark_t{});
  bus.handle(100);
  CHECK(marks == 10);
  CHECK(bus.statistics().refused.empty());
}
