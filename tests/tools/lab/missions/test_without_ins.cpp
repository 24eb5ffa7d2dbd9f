// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Missions of a robot without an INS, and of one that loses its INS.
#include <catch2/catch.hpp>

#include <cmath>

#include "common/messages/ins_messages.hpp"
#include "tools/lab/missions/referee.hpp"
#include "tools/lab/missions/robot_system.hpp"

using namespace tread;
using namespace tread::missions;

namespace {

constexpr const char* kRobot = TREAD_SOURCE_DIR "/config/robots/teodor_without_ins";

/// The same with an INS, whose gaps scan matching fills.
RobotConfig filledIn() {
  return readRobot(kRobot, {"scan_matching.channel=SCAN_MATCHING"});
}

struct Drive {
  Drive(const RobotConfig& robot, uint64_t seed)
      : world(makeMissionWorld(seed, {0.65, 0.65, 0.34})),
        system(robot, world.description, world.T_map_start, seed, "multi_model", {}),
        watch(system, world),
        person(system.bus().outside(), world.T_map_goal) {
    system.bus().outside().subscribe<ins_t>(kIns, [this](const ins_t& message) {
      const auto pose = planarPose(message);
      if (!pose) return;
      ++poses;
      if ((message.ins_status & ins_t::STATUS_FILLED_IN) != 0) ++filled_in;
      told = std::hypot(message.position_std[0], message.position_std[1]);
      error = distanceBetween(*pose, system.robot().truth().T_map_body);
      worst = std::max(worst, distanceBetween(*pose, system.robot().truth().T_map_body));
    });
    system.bus().outside().subscribe<motor_t>(kMotor, [this](const motor_t& message) {
      driving = message.bridge_state == motor_t::STATE_DRIVING;
    });
  }
  void run(double seconds) {
    const int64_t end = system.bus().now() + std::llround(seconds * 1e6);
    while (system.bus().now() < end && !watch.ended()) {
      system.bus().runUntil(system.bus().now() + 50'000);
      person.step(system.bus().now());
      watch.step();
    }
  }
  void runToEnd() {
    while (!watch.ended()) run(1.0);
  }

  MissionWorld world;
  RobotSystem system;
  Referee watch;
  Operator person;
  int poses = 0;
  int filled_in = 0;
  double error = 0.0;  ///< [m] of the last pose
  double told = 0.0;   ///< [m] published standard deviation
  /// [m] largest distance to the present true pose; a pose is as old as its transmission
  double worst = 0.0;
  bool driving = false;
};

}  // namespace

TEST_CASE("an INS that is silent while the robot drives is filled in for, and it drives on") {
  Drive drive(filledIn(), 14);
  while (!drive.driving) drive.run(0.1);
  drive.run(2.0);
  CHECK(drive.filled_in == 0);
  drive.system.connect("ins", false);
  drive.run(10.0);
  CHECK(drive.driving);
  CHECK(drive.filled_in >= 95);
  drive.system.connect("ins", true);
  drive.runToEnd();
  const MissionResult result = drive.watch.result();
  INFO(result.reason);
  CHECK(result.outcome == MissionOutcome::kArrived);
  CHECK(drive.person.rearmed() == 0);
  CHECK(drive.worst < 0.4);
}

TEST_CASE("without scan matching the same silence stops the robot") {
  RobotConfig robot = filledIn();
  robot.scan_matching.reset();
  Drive drive(robot, 14);
  while (!drive.driving) drive.run(0.1);
  drive.run(2.0);
  drive.system.connect("ins", false);
  drive.run(2.0);
  CHECK_FALSE(drive.driving);
  CHECK(drive.filled_in == 0);
}

TEST_CASE("a robot without an INS drives missions by its range finder alone") {
  Drive drive(readRobot(kRobot), 309);
  drive.runToEnd();
  const MissionResult result = drive.watch.result();
  INFO(result.reason);
  CHECK(result.outcome == MissionOutcome::kArrived);
  CHECK(drive.worst < 0.5);
  CHECK(drive.error <= 2.0 * drive.told);
}

// Not part of the tests: the figures of RESULTS.md.
TEST_CASE("figures of missions by the range finder alone", "[.figures]") {
  int arrived = 0, touched = 0, within_two = 0, missions = 0;
  for (uint64_t seed = 301; seed <= 320; ++seed) {
    Drive drive(readRobot(kRobot), seed);
    drive.runToEnd();
    const MissionResult result = drive.watch.result();
    ++missions;
    arrived += result.outcome == MissionOutcome::kArrived ? 1 : 0;
    touched += result.collisions() > 0 ? 1 : 0;
    within_two += drive.error <= 2.0 * drive.told ? 1 : 0;
    std::printf(
        "%d: %s after %.1f m, %.2f m off at the end (told %.2f), worst %.2f, armed again %d; %s\n",
        static_cast<int>(seed),
        result.outcome == MissionOutcome::kArrived ? "arrived" : "not arrived", result.distance,
        drive.error, drive.told, drive.worst, result.rearmed, result.reason.c_str());
  }
  std::printf("%d of %d arrived, %d touched, %d within two told deviations\n", arrived, missions,
              touched, within_two);
}
