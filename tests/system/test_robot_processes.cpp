// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <csignal>

#include <catch2/catch.hpp>

#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"

namespace tread::testing {
namespace {

const std::string kRobot = TREAD_SOURCE_DIR "/config/robots/teodor/";

/// It stops the robot, HEALTH names both, and after its end the robot drives again.
void mustNotBearSecondPlanner(RobotRun& run) {
  const auto drives = [&] { return run.driving(); };
  REQUIRE(run.untilDriving(20.0, drives));
  {
    Process second("tread-planner", {"--config", kRobot + "planner.yaml", "--lcm-url", run.url()},
                   run.folder() + "/second.log");
    REQUIRE(run.until(10.0, [&] { return !run.armed(); }));
    CHECK_THAT(run.motor().message().state_reason, Catch::Contains("planner"));
    CHECK(run.until(10.0, [&] {
      const auto health = run.health().find("planner");
      return health->second.health_reason.find("two processes planner run") != std::string::npos;
    }));
    run.arm(2.0);
    run.wait(0.5);
    CHECK_FALSE(run.armed());
  }
  REQUIRE(run.arm(20.0));
  CHECK(run.untilDriving(20.0, drives));
}

}  // namespace

TEST_CASE("every process starts alone, tells its health, and ends with code 0") {
  for (const std::string& name : RobotRun::names()) {
    for (const int how : {SIGINT, SIGTERM}) {
      RobotRun run(kYard, "[-6, 0, 0]");
      run.start(name);
      INFO(name << " by signal " << how);
      CHECK(run.until(10.0, [&] { return run.health().count(name) == 1; }));
      CHECK(run.running(name));
      CHECK(run.end(name, how) == 0);
    }
  }
}

TEST_CASE("a second simulator on the same lines says so and ends") {
  RobotRun run(kYard, "[-6, 0, 0]");
  run.start("simulator");
  REQUIRE(run.until(10.0, [&] { return run.health().count("simulator") == 1; }));
  const std::string port = run.laserAddress();
  Process second("tread-simulator",
                 {"--lcm-url", run.url(), "--set", "world=" + run.folder() + "/world.yaml", "--set",
                  "robot=" + kRobot + "robot.yaml", "--set", "dynamics=" + kRobot + "dynamics.yaml",
                  "--set", "ins=pty:" + run.folder() + "/ins2", "--set",
                  "motor=pty:" + run.folder() + "/motor2", "--set", "laser=" + port},
                 run.folder() + "/second.log");
  REQUIRE(second.waitFor(10.0));
  CHECK(second.exitCode() == 1);
  CHECK_THAT(run.output("second"), Catch::Contains(port) && Catch::Contains("another simulator"));
}

TEST_CASE(
    "a second planner stops the robot until it is gone, beside a second learner no version goes "
    "back, and with the first gone the second teaches") {
  RobotRun run(kField, "[-20, 0, 0]");
  int64_t newest = 0;
  int back = 0;
  run.bus().subscribe<pattern_set_part_t>(kPatternSet, [&](const pattern_set_part_t& part) {
    back += part.set_version < newest;
    newest = std::max(newest, part.set_version);
  });
  run.startAll();
  run.setGoal(30.0, 0.0);
  REQUIRE(run.arm(20.0));
  mustNotBearSecondPlanner(run);
  REQUIRE(run.untilDriving(20.0, [&] { return run.driving() && newest > 0; }));
  Process second("tread-learner",
                 {"--config", kRobot + "learner.yaml", "--set", "store=" + run.state("second"),
                  "--lcm-url", run.url()},
                 run.folder() + "/second.log");
  CHECK(run.untilDriving(10.0, [&] {
    const auto health = run.health().find("learner");
    return health->second.health_reason.find("two processes learner run") != std::string::npos;
  }));
  run.untilDriving(5.0, [] { return false; });
  CHECK(run.end("learner") == 0);
  const int64_t before = newest;
  CHECK(run.untilDriving(20.0, [&] { return newest > before; }));
  CHECK(back == 0);
  CHECK(second.running());
}

TEST_CASE("started in the wrong order, the robot drives to its goal and touches nothing") {
  RobotRun run(kYard, "[-6, 0, 0]");
  const auto& names = RobotRun::names();
  for (size_t i = names.size(); i-- > 0;) {
    run.start(names[i]);
    run.wait(0.3);
  }
  run.setGoal(6.0, 2.0);
  REQUIRE(run.arm(20.0));
  CHECK(run.untilDriving(90.0,
                         [&] { return run.plan().message().plan_status == plan_t::PLAN_ARRIVED; }));
  INFO("armed again " << run.armedAgain() << " times");
  CHECK(run.armedAgain() <= 3);
  for (const std::string& name : names) {
    INFO(name << ": " << run.output(name));
    CHECK(run.running(name));
    CHECK(run.end(name) == 0);
  }
  const auto truth = run.truth();
  REQUIRE(!truth.empty());
  CHECK(truth.back().contacts == 0);
  CHECK(std::hypot(truth.back().T_map_body.x - 6.0, truth.back().T_map_body.y - 2.0) < 0.8);
  CHECK(truth.back().motorsAtZero());
}

TEST_CASE(
    "a second run in the same place goes on with what was learned and moves nothing by itself") {
  RobotRun run(kField, "[0, 0, 0]");
  run.startAll();
  run.setGoal(15.0, 0.0);
  REQUIRE(run.arm(20.0));
  const int64_t first = run.lastSet();
  REQUIRE(run.untilDriving(30.0, [&] { return run.lastSet() >= first + 3; }));
  const int64_t learned = run.lastSet();
  run.endAll();
  run.forgetSet();
  const int64_t again = run.now();
  run.startAll();
  // The goal is still repeated each second; without arming nothing may move.
  REQUIRE(run.until(20.0, [&] {
    return run.motor().message().utime > again && run.plan().message().utime > again;
  }));
  run.wait(3.0);
  CHECK(run.lastSet() >= learned);
  for (const sim::TruthRow& row : run.truth()) {
    if (row.utime > again) CHECK(row.motorsAtZero());
  }
  REQUIRE(run.arm(10.0));
  CHECK(run.untilDriving(20.0, [&] { return run.lastSet() > learned; }));
}

}  // namespace tread::testing
