// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <csignal>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"

namespace tread::testing {
namespace {

const std::string kPad = "A: 00 0 255 0 0 0\nA: 01 0 255 0 0 0\nE: 0.000000 0000 0000 0\n";
const std::string kForward =
    "E: 1.000000 0001 0137 1\n"   // shoulder button
    "E: 1.300000 0003 0001 0\n";  // stick forward
const std::string kLetGo = "E: 4.000000 0003 0001 128\nE: 4.100000 0001 0137 0\n";
const std::string kGiveBack = "E: 6.000000 0001 0133 1\nE: 6.100000 0001 0133 0\n";
const std::string kEnd = "E: 30.000000 0000 0000 0\n";

/// tread-drive with recorded events, for the operator of the run.
std::unique_ptr<Process> handOf(const RobotRun& run, const std::string& events) {
  const std::string path = run.folder() + "/pad.evemu";
  std::ofstream(path) << kPad + events + kEnd;
  return std::make_unique<Process>(
      "tread-drive",
      std::vector<std::string>{"--events", path, "--operator", "test", "--lcm-url", run.url()},
      run.folder() + "/drive.log");
}

bool byHand(const RobotRun& run) {
  return run.motor().message().bridge_state == motor_t::STATE_MANUAL;
}

}  // namespace

TEST_CASE("with real processes a recorded stick takes over, gives back, and the robot arrives") {
  RobotRun run(kYard, "[-6, 0, 0]");
  int64_t moved = 0;  // [us] the first message of a moved stick, and the first MOTOR by hand
  int64_t taken = 0;
  run.bus().subscribe<manual_t>(kManual, [&](const manual_t& m) {
    if (m.hold && m.hand_left != 0.0F && moved == 0) moved = run.now();
  });
  run.bus().subscribe<motor_t>(kMotor, [&](const motor_t& m) {
    if (m.bridge_state == motor_t::STATE_MANUAL && taken == 0) taken = run.now();
  });
  run.startAll();
  run.setGoal(6.0, 2.0);
  REQUIRE(run.arm(20.0));
  REQUIRE(run.untilDriving(20.0, [&] { return run.driving(); }));
  auto hand = handOf(run, kForward + kLetGo + kGiveBack);
  INFO(run.output("drive"));
  REQUIRE(run.until(10.0, [&] { return taken > 0 && moved > 0; }));
  CHECK(taken - moved <= 100'000);
  INFO("taken over after " << (taken - moved) / 1000 << " ms");
  CHECK(run.until(3.0, [&] { return run.motor().message().command_left > 0.45F; }));
  CHECK(byHand(run));
  // Meanwhile the planner shows what it would do, and orders nothing.
  CHECK(run.plan().message().num_patterns > 0);
  CHECK(run.plan().message().goal_id != 0);
  CHECK(run.plan().message().reason == "driven by hand by test");
  CHECK(run.program().message().running.execution_id == 0);
  CHECK(run.until(6.0, [&] { return run.motor().message().command_left == 0.0F; }));
  CHECK(byHand(run));
  CHECK(run.until(10.0, [&] { return run.driving(); }));
  hand->signal(SIGTERM);
  CHECK(hand->waitFor(5.0));
  CHECK(run.armed());  // ending while the planner drives disarms nothing

  hand = handOf(run, kForward);
  REQUIRE(
      run.until(10.0, [&] { return run.motor().message().command_left > 0.4F && byHand(run); }));
  hand->signal(SIGKILL);
  const int64_t killed = run.now();
  run.wait(1.5);
  const std::optional<int64_t> zero = zeroAfter(run.truth(), killed, 1'000'000);
  REQUIRE(zero);
  INFO("zero " << (*zero - killed) / 1000 << " ms after the hand was killed");
  CHECK(*zero - killed <= 250'000);
  CHECK(byHand(run));
  CHECK(run.motor().message().state_reason == "in the hand of test, who is silent");

  hand = handOf(run, kGiveBack);
  CHECK(run.untilDriving(60.0,
                         [&] { return run.plan().message().plan_status == plan_t::PLAN_ARRIVED; }));
  const auto truth = run.truth();
  REQUIRE(!truth.empty());
  CHECK(truth.back().contacts == 0);
}

}  // namespace tread::testing
