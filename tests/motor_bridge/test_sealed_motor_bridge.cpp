// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The bridge of a robot with a key, and a sender on its bus without the key.
#include <catch2/catch.hpp>

#include "tests/motor_bridge/node_world.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

/// A world with a key, and an attacker who receives everything and sends anything.
struct AttackedWorld : NodeWorld {
  AttackedWorld() : NodeWorld(1, {}, {}, SealKey{}) {
    bus.setTap([this](int64_t, const char* channel, const uint8_t* bytes, size_t size) {
      overheard.emplace_back(channel, std::vector<uint8_t>(bytes, bytes + size));
    });
  }
  template <class Message>
  void forge(const Channel<Message>& channel, const Message& message) {
    std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    bus.inject(channel.name, bytes.data(), bytes.size());
  }
  void forgeArm(bool armed) {
    arm_t message{};
    message.utime = now();
    message.armed = armed;
    message.armed_by = "stranger";
    forge(kArm, message);
  }
  void forgeStop(bool engaged) {
    estop_t message{};
    message.utime = now();
    message.engaged = engaged;
    message.estop_by = "stranger";
    forge(kEstop, message);
  }
  bool keeps(const Fence& fence) const {
    const std::vector<Fence> kept = fencesFrom(fences);
    return std::count(kept.begin(), kept.end(), fence) == 1;
  }
  int64_t refused(const std::string& why) const {
    const auto& counts = bus.statistics("motor_bridge").refused;
    return counts.count(why) > 0 ? counts.at(why) : 0;
  }
  std::vector<std::pair<std::string, std::vector<uint8_t>>> overheard;
};

}  // namespace

TEST_CASE("with a key it drives as without one, and refuses nothing") {
  AttackedWorld world;
  world.drive();
  CHECK(world.drives());
  world.run(5'000'000);
  CHECK(world.drives());
  CHECK(world.bus.statistics("motor_bridge").refused.empty());
}

TEST_CASE("a forged ARM and PROGRAM move nothing, and both are counted in HEALTH") {
  AttackedWorld world;
  world.bus.kill("planner");
  world.run(1'000'000);
  EndlessPlanner planner(77);
  for (int i = 0; i < 60; ++i) {
    world.forge(kProgram, toMessage(planner.plan(world.now(), {})));
    world.forgeArm(true);
    world.run(50'000);
  }
  CHECK(world.moving.empty());
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
  CHECK(world.refused("unsealed") == 120);
  world.run(1'000'000);
  CHECK(world.counter("refused: unsealed") == 120);
}

TEST_CASE("forged programs among true ones do not steer a robot that drives") {
  AttackedWorld world;
  world.drive();
  program_t forged = toMessage(EndlessPlanner(77).plan(world.now(), {}));
  for (int i = 0; i < 100; ++i) {
    forged.utime = world.now();
    forged.seq = 1'000'000 + i;
    world.forge(kProgram, forged);
    world.run(10'000);
    REQUIRE(world.drives());
    CHECK(world.motor.motor_run_id != 77);
  }
  CHECK(world.refused("unsealed") == 100);
}

TEST_CASE("a stranger's fence holds it, but only the operator takes a fence away") {
  AttackedWorld world;
  world.drive();
  const FenceRequest fence{
      "stranger", false, {"trap", false, {{-9, -9}, {9, -9}, {9, 9}, {-9, 9}}}};
  world.forge(kFence, toMessage(fence));
  world.run(1'200'000);
  CHECK(world.drives());
  CHECK(world.keeps(fence.fence));
  FenceRequest removal{"operator", true, {"trap", false, {}}};
  world.forge(kFence, toMessage(removal));
  world.run(1'200'000);
  CHECK(world.keeps(fence.fence));
  CHECK(world.refused("unsealed") == 1);
  removal.by = "bob";
  world.bus.outside().publish(kFence, toMessage(removal));
  world.run(1'200'000);
  CHECK(world.keeps(fence.fence));
  removal.by = "operator";
  world.bus.outside().publish(kFence, toMessage(removal));
  world.run(1'200'000);
  CHECK_FALSE(world.keeps(fence.fence));
  CHECK(world.drives());
}

TEST_CASE("a stranger's fences in the operator's name do not keep the operator's own out") {
  AttackedWorld world;
  world.drive();
  FenceRequest request{"operator", false, {"far", true, {{90, 0}, {91, 0}, {90, 1}}}};
  for (size_t i = 0; i < FenceBook::kMost; ++i) {
    request.fence.corners[0].x() += 1e-3;
    world.forge(kFence, toMessage(request));
  }
  world.run(1'200'000);
  CHECK(world.counter("FENCE added") == FenceBook::kMost);
  request.fence.name = "people";
  world.bus.outside().publish(kFence, toMessage(request));
  world.run(1'200'000);
  CHECK(world.keeps(request.fence));
  CHECK(world.drives());
}

TEST_CASE("a stranger's stop stops it, but only the operator clears it and arms again") {
  AttackedWorld world;
  world.drive();
  world.forgeStop(true);
  CHECK(world.lastMotionWithin(1'000'000) <= 50'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_ESTOP);
  world.forgeStop(false);
  world.forgeArm(true);
  world.run(500'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_ESTOP);
  CHECK(world.refused("unsealed") == 2);
  world.estop(false);
  world.run(1'500'000);
  world.say(true);
  world.run(300'000);
  CHECK(world.drives());
  world.forgeArm(false);
  CHECK(world.lastMotionWithin(1'000'000) <= 50'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
}

TEST_CASE("what was overheard moves nothing later, neither while it waits nor after a restart") {
  AttackedWorld world;
  world.drive();
  world.run(300'000);
  const auto recorded = world.overheard;
  world.bus.kill("planner");
  world.run(500'000);
  world.bus.restart("motor_bridge");
  const size_t moved = world.moving.size();
  const auto play = [&] {
    for (const auto& [channel, bytes] : recorded)
      if (channel == "ARM" || channel == "PROGRAM") {
        world.bus.inject(channel.c_str(), bytes.data(), bytes.size());
        world.run(1'000);
      }
  };
  play();
  CHECK(world.refused("too old") > 5);
  world.run(3'000'000);
  play();
  CHECK(world.moving.size() == moved);
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
}

TEST_CASE("with a key nobody takes the robot over by forged or repeated MANUAL") {
  AttackedWorld world;
  world.drive();
  manual_t hand{};
  hand.station = 7;
  hand.operator_name = "operator";
  for (int i = 0; i < 60; ++i) {
    hand.seen_utime = world.motor.utime;
    hand.seq = i;
    hand.hold = i > 10;
    hand.hand_left = hand.hand_right = i > 10 ? 1.0F : 0.0F;
    world.forge(kManual, hand);
    world.run(20'000);
  }
  CHECK(world.drives());
  CHECK(world.refused("unsealed") == 60);
  world.overheard.clear();
  hand.hold = false;
  hand.seq = 100;
  world.bus.outside().publish(kManual, hand);
  world.run(20'000);
  for (const auto& [channel, bytes] : world.overheard)
    if (channel == kManual.name) world.bus.inject(kManual.name, bytes.data(), bytes.size());
  world.run(20'000);
  CHECK(world.refused("replayed") == 1);
}
