// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <csignal>

#include <catch2/catch.hpp>

#include "tests/system/robot_run.hpp"
#include "tests/system/worlds.hpp"

namespace tread::testing {

TEST_CASE("every process starts alone, tells its health, and ends with code 0") {
  for (const std::string& name : RobotRun::names()) {
    for (const int how : {SIGINT, SIGTERM}) {
      RobotRun run(kYard, "[-6, 0, 0]");
      run.start(name);
      INFO(name << " by signal " << how << "\n" << run.output(name));
      CHECK(run.until(10.0, [&] { return run.health().count(name) == 1; }));
      CHECK(run.running(name));
      run.signal(name, how);
      CHECK(run.end(name) == 0);
    }
  }
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
  int armed_again = 0;
  const auto arrived = [&] {
    // A busy machine may hold an INS message back long enough to stop the robot: arm again.
    if (run.motor().message().bridge_state == motor_t::STATE_DISARMED && run.arm()) ++armed_again;
    return run.plan().message().plan_status == plan_t::PLAN_ARRIVED;
  };
  CHECK(run.until(90.0, arrived));
  INFO("armed again " << armed_again << " times");
  CHECK(armed_again <= 3);
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
  const int64_t first = run.newestSet();
  REQUIRE(run.until(30.0, [&] { return run.newestSet() >= first + 3; }));
  const int64_t learned = run.newestSet();
  run.endAll();
  const int64_t again = run.now();
  run.startAll();
  // The goal still comes each second; without arming nothing may move.
  REQUIRE(run.until(20.0, [&] {
    return run.motor().message().utime > again && run.plan().message().utime > again;
  }));
  run.wait(3.0);
  CHECK(run.newestSet() >= learned);
  for (const sim::TruthRow& row : run.truth()) {
    if (row.utime > again) CHECK(row.motorsAtZero());
  }
  REQUIRE(run.arm(10.0));
  CHECK(run.until(20.0, [&] { return run.newestSet() > learned; }));
}

}  // namespace tread::testing
