// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tools/lab/missions/mission_runner.hpp"
#include "tools/lab/missions/speed_comparison.hpp"

using namespace tread;
using namespace tread::missions;

namespace {

MissionResult driveRough(const std::string& method) {
  RobotConfig robot = readRobot(TREAD_SOURCE_DIR "/config/robots/teodor_ground");
  enterWorld(robot, "rough");
  return runMission(withSpeedBy(method, robot), 201, {}).result;
}

double speed(const sim::Shaking& ground) {
  return ground.distance / ground.time;
}

}  // namespace

TEST_CASE("by what it sees and feels the robot is slow on rough ground and fast on smooth ground") {
  const MissionResult fast = driveRough("fast");
  const MissionResult chosen = driveRough("learned");
  REQUIRE(fast.outcome == MissionOutcome::kArrived);
  REQUIRE(chosen.outcome == MissionOutcome::kArrived);
  CHECK(chosen.collisions() == 0);
  const auto shock = [](const MissionResult& r) { return r.rough.rms(r.rough.acceleration_sum); };
  CHECK(shock(chosen) < 0.6 * shock(fast));
  CHECK(speed(chosen.rough) < 0.75 * speed(fast.rough));
  CHECK(speed(chosen.smooth) > 0.75 * speed(fast.smooth));
}

TEST_CASE("every way to choose the speed is a configuration of the same robot") {
  const RobotConfig robot = readRobot(TREAD_SOURCE_DIR "/config/robots/teodor_ground");
  CHECK(withSpeedBy("fast", robot).planner.search.shock.weight == 0.0);
  CHECK(withSpeedBy("slow", robot).planner.search.top_speed < 0.7);
  CHECK_FALSE(withSpeedBy("seen", robot).learner.shock);
  CHECK(withSpeedBy("felt", robot).mapping.map.roughness.range_noise == 0.0);
  CHECK(withSpeedBy("learned", robot).planner.search.shock.weight > 0.0);
}
