// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <functional>
#include <random>

#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "tests/motor_bridge/node_world.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

/// The motors must not turn this long after the end of a lease or series [us].
constexpr int64_t kBudget = 250'000;

/// Longest time from a cause to the last motion [us], over 200 times in a drive (shown by -s; fewer
/// in an instrumented build: each must keep the limit).
int64_t worst(const std::function<void(NodeWorld&)>& cause) {
  std::mt19937_64 random(9);
  int64_t longest = 0;
  NodeWorld world;
  world.planner().planner.commands = 40;
  for (int i = 0; i < testing::effort(200); ++i) {
    world.drive();
    world.run(static_cast<int64_t>(random() % 3'000'000));
    REQUIRE(world.drives());
    cause(world);
    longest = std::max(longest, world.lastMotionWithin(600'000));
    REQUIRE(world.stoodFor() >= 300'000);
    // Restore everything for the next round.
    setPipeConnected(*world.pipe.first, true);
    world.device.fault_flags = 0;
    world.device.mute = world.device.deaf = false;
    for (const char* node : {"planner", "ins", "motor_bridge"}) {
      if (world.bus.node(node) == nullptr) world.bus.restart(node);
    }
    world.planner().planner.commands = 40;
    world.run(1'500'000);
  }
  return longest;
}

}  // namespace

TEST_CASE("planner dead: zero within 250 ms of its last word, a lease of 200 ms included") {
  CHECK(worst([](NodeWorld& world) { world.bus.kill("planner"); }) <= kBudget);
}

TEST_CASE("INS dead: zero within 250 ms") {
  CHECK(worst([](NodeWorld& world) { world.bus.kill("ins"); }) <= kBudget);
}

TEST_CASE("E-stop or disarming: zero within 20 ms") {
  CHECK(worst([](NodeWorld& world) { world.say(false); }) <= 20'000);
}

TEST_CASE("line cut: the controller's watchdog needs 250 ms from the last command") {
  CHECK(worst([](NodeWorld& world) { setPipeConnected(*world.pipe.first, false); }) <=
        kBudget + 5'000);
}

TEST_CASE("motor_bridge dead: the controller's watchdog needs 250 ms from the last command") {
  CHECK(worst([](NodeWorld& world) { world.bus.kill("motor_bridge"); }) <= kBudget + 5'000);
}

TEST_CASE("controller deaf: its watchdog needs 250 ms from the last command") {
  CHECK(worst([](NodeWorld& world) { world.device.deaf = true; }) <= kBudget + 5'000);
}

TEST_CASE("controller mute: zero reaches it all the same, after 250 ms without acknowledgement") {
  CHECK(worst([](NodeWorld& world) { world.device.mute = true; }) <= kBudget + 30'000);
}

TEST_CASE("controller in fault: zero within 60 ms, its flags are asked for with every query") {
  CHECK(worst([](NodeWorld& world) { world.device.fault_flags = 4; }) <= 60'000);
}

TEST_CASE("controller in fault on a line that loses eight replies in a row: zero within 250 ms") {
  CHECK(worst([](NodeWorld& world) {
          world.device.lose = 8;
          world.device.fault_flags = 4;
        }) <= kBudget);
}

TEST_CASE("planner dead and line cut at the same moment: still 250 ms from its last word") {
  CHECK(worst([](NodeWorld& world) {
          world.bus.kill("planner");
          setPipeConnected(*world.pipe.first, false);
        }) <= kBudget + 5'000);
}

TEST_CASE("series end without a next: zero within a step and the way to the controller") {
  NodeWorld world;
  world.planner().planner.commands = 7;
  world.planner().planner.endless = false;
  int64_t longest = 0;
  world.run(1'700'000);
  world.say(true);
  for (int i = 0; i < 20'000; ++i) {
    world.run(10'000);
    const auto& records = world.execution.records;
    if (records.empty() || records.back().outcome == execution_record_t::OUTCOME_RUNNING) continue;
    REQUIRE(records.back().outcome == execution_record_t::OUTCOME_COMPLETED);
    longest = std::max(longest, world.moving.back() - records.back().ended);
  }
  CHECK(world.execution.records.back().record_execution_id > 300);
  CHECK(longest <= 20'000);
}
