// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "tools/lab/missions/mission.hpp"
#include "tools/lab/missions/mission_runner.hpp"
#include "tools/lab/missions/robot_system.hpp"

namespace tread::missions {
namespace {

const std::string kOmni = TREAD_SOURCE_DIR "/tests/data/robots/omni3";

/// Directions of a mission's measured executions.
struct Ways {
  int ahead = 0, aside = 0, turning = 0;

  void add(const MissionResult& result) {
    for (const ScoredExecution& execution : result.executions) {
      if (!execution.measured) continue;
      const Pose2& end = execution.measured_end;
      if (execution.turned > 0.2) ++turning;
      if (execution.path_length < 0.1) continue;
      ++(std::abs(end.y) > std::abs(end.x) ? aside : ahead);
    }
  }
};

RobotConfig omniWith(const std::string& motor_bridge) {
  RobotConfig robot = readRobot(kOmni);
  ConfigReader reader =
      ConfigReader::fromText("robot: robot.yaml\n" + motor_bridge, kOmni + "/motor_bridge.yaml");
  robot.motor_bridge = motor::readMotorBridgeConfig(reader);
  return robot;
}

}  // namespace

TEST_CASE(
    "a holonomic base drives ahead, sideways and turning to its goals, and learns its ground") {
  const RobotConfig robot = readRobot(kOmni);
  Ways ways;
  int64_t versions = 0;
  for (const uint64_t seed : {8u, 22u}) {
    MissionOptions options;
    options.shortest_line = 12.0;
    const MissionRun run = runMission(robot, seed, options);
    CAPTURE(seed, run.result.reason, run.result.rearmed);
    CHECK(run.result.outcome == MissionOutcome::kArrived);
    CHECK(run.result.collisions() == 0);
    CHECK(run.result.rearmed == 0);
    ways.add(run.result);
    versions += run.result.set_versions;
  }
  CAPTURE(ways.ahead, ways.aside, ways.turning);
  CHECK(ways.ahead > 0);
  CHECK(ways.aside > 0);
  CHECK(ways.turning > 0);
  CHECK(versions > 10);
}

TEST_CASE(
    "a holonomic base drives through each controller that has as many motors as it has wheels") {
  const std::string wheels = TREAD_SOURCE_DIR "/tests/data/controllers/mole_wheels.yaml";
  for (const std::string& bridge :
       {"controller: line_protocol\nline_protocol: " + wheels + "\n",
        std::string("controller: vesc_can\nvesc_can: {pole_pairs: 7, gear_ratio: 7.48, "
                    "wheel_radius: 0.1}\n")}) {
    MissionOptions options;
    options.shortest_line = 8.0;
    const MissionRun run = runMission(omniWith(bridge), 8, options);
    CAPTURE(bridge, run.result.reason);
    CHECK(run.result.outcome == MissionOutcome::kArrived);
    CHECK(run.result.collisions() == 0);
  }
}

TEST_CASE("patterns of another vehicle are refused with both commands before a mission begins") {
  const std::string car = TREAD_SOURCE_DIR "/tests/data/robots/car/patterns.yaml";
  CHECK_THROWS_WITH(readRobot(kOmni, {"learner.patterns=" + car}),
                    Catch::Contains("throttle [1], steering [rad]") &&
                        Catch::Contains("wheel1 [m/s], wheel2 [m/s], wheel3 [m/s]"));
}

}  // namespace tread::missions
