// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <csignal>
#include <fstream>

#include <catch2/catch.hpp>

#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"

namespace tread::testing {
namespace {

/// The kernel's initial values, then the stick's first report: at rest.
const std::string kPad =
    "A: 00 0 255 0 0 0\nA: 01 0 255 0 0 0\nE: 0.000000 0003 0000 0\nE: 0.000000 0003 0001 0\n"
    "E: 0.100000 0003 0000 128\nE: 0.100000 0003 0001 128\nE: 0.100000 0000 0000 0\n";
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
  int64_t moved = 0;  // [us] first message of a moved stick, and first MOTOR under manual control
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
  // A stall of a busy machine may disarm the robot, or hide the stick's rest.
  std::unique_ptr<Process> hand;
  for (int tries = 0; tries < 3 && (taken == 0 || moved == 0); ++tries) {
    REQUIRE(run.untilDriving(20.0, [&] { return run.driving(); }));
    moved = 0;
    hand = handOf(run, kForward + kLetGo + kGiveBack);
    run.until(3.5, [&] { return taken > 0 && moved > 0; });
  }
  INFO(run.output("drive") << run.motor().message().state_reason);
  REQUIRE((taken > 0 && moved > 0));
  CHECK(taken - moved <= 100'000);
  INFO("taken over after " << (taken - moved) / 1000 << " ms");
  // The following holds unless a stall of a busy machine disarms the robot.
  const auto unless_stalled = [&](double seconds, const std::function<bool()>& condition) {
    return run.until(seconds, [&] { return condition() || !run.armed(); });
  };
  CHECK(unless_stalled(3.0, [&] { return run.motor().message().command[0] > 0.45F; }));
  if (run.armed()) {
    CHECK(byHand(run));
    // Meanwhile the planner shows its plan, but commands nothing.
    CHECK(unless_stalled(1.0, [&] { return run.plan().message().num_patterns > 0; }));
    CHECK(run.program().message().running.execution_id == 0);
  }
  CHECK(unless_stalled(6.0, [&] { return run.motor().message().command[0] == 0.0F; }));
  CHECK(run.untilDriving(20.0, [&] { return run.driving(); }));
  hand->signal(SIGTERM);
  CHECK(hand->waitFor(5.0));

  const auto moves_by_hand = [&] { return run.motor().message().command[0] > 0.4F && byHand(run); };
  for (int tries = 0; tries < 3 && !moves_by_hand(); ++tries) {
    REQUIRE(run.untilDriving(20.0, [&] { return run.driving(); }));
    hand = handOf(run, kForward);
    run.until(5.0, moves_by_hand);
  }
  REQUIRE(moves_by_hand());
  hand->signal(SIGKILL);
  const int64_t killed = run.now();
  std::optional<int64_t> zero;
  run.until(5.0, [&] {
    run.wait(0.2);
    zero = zeroAfter(run.truth(), killed, 1'000'000);
    return zero.has_value();
  });
  REQUIRE(zero);
  INFO("zero " << (*zero - killed) / 1000 << " ms after the hand was killed");
  CHECK(*zero - killed <= 250'000);
  if (run.armed()) {
    CHECK(byHand(run));
    CHECK(run.motor().message().state_reason == "in the hand of test, who is silent");
  }

  hand = handOf(run, kGiveBack);
  CHECK(run.untilDriving(60.0,
                         [&] { return run.plan().message().plan_status == plan_t::PLAN_ARRIVED; }));
  const auto truth = run.truth();
  REQUIRE(!truth.empty());
  CHECK(truth.back().contacts == 0);
}

}  // namespace tread::testing
