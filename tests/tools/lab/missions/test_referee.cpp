// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The referee's decisions on tracks and messages from the test.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "common/messages/blank.hpp"
#include "tests/tools/lab/missions/shipped_robot.hpp"
#include "tools/lab/missions/referee.hpp"

using namespace tread;
using namespace tread::missions;

namespace {

MissionWorld flatWorld(double goal_x) {
  MissionWorld world;
  world.T_map_goal = {goal_x, 0.0, 0.0};
  world.straight_line = goal_x;
  world.description.name = "flat";
  world.description.base_surface = "tarmac";
  return world;
}

/// Simulator and referee only: every other process is killed; the test publishes their messages and
/// sets the motors' power.
struct Stage {
  explicit Stage(MissionWorld there)
      : world(std::move(there)),
        system(teodor(), world.description, world.T_map_start, 1, "off", {}),
        referee(system, world) {
    for (const std::string& node : robotNodes()) system.bus().kill(node);
    system.connect("motor", false);
  }

  /// Both motors with this power [1] for a time [s].
  void drive(double power, double seconds) {
    const sim::MotorWiring& wiring = system.robot().settings().wiring;
    const int right_channel = wiring.left_channel == 1 ? 2 : 1;
    const auto command = [&](int channel, bool inverted) {
      return "!G " + std::to_string(channel) + " " +
             std::to_string(std::lround((inverted ? -1000.0 : 1000.0) * power)) + "\r";
    };
    const int64_t end = system.bus().now() + std::llround(seconds * 1e6);
    while (system.bus().now() < end && !referee.ended()) {
      system.devices().motor().receive(command(wiring.left_channel, wiring.invert_left) +
                                           command(right_channel, wiring.invert_right),
                                       system.bus().now());
      tick();
    }
  }
  void wait(double seconds) {
    const int64_t end = system.bus().now() + std::llround(seconds * 1e6);
    while (system.bus().now() < end && !referee.ended()) tick();
  }
  void plan(int16_t status, const std::string& reason = "") {
    auto message = blank<plan_t>();
    message.utime = system.bus().now();
    message.goal_id = 1;
    message.plan_status = status;
    message.reason = reason;
    system.bus().outside().publish(kPlan, message);
  }
  void execution(int64_t id, int16_t outcome, const std::string& reason = "") {
    execution_record_t record{};
    record.record_run_id = 3;
    record.record_execution_id = id;
    record.record_pattern_id = system.patterns().findByName("straight")->id;
    record.started = system.bus().now() - 400'000;
    record.ended = system.bus().now();
    record.outcome = outcome;
    record.outcome_reason = reason;
    auto message = blank<execution_t>();
    message.utime = system.bus().now();
    message.num_records = 1;
    message.records = {record};
    system.bus().outside().publish(kExecution, message);
  }

  MissionWorld world;
  RobotSystem system;
  Referee referee;

 private:
  void tick() {
    system.bus().runUntil(system.bus().now() + 50'000);
    referee.step();
  }
};

}  // namespace

TEST_CASE("a collision is one contact with time, place and pattern, however long it touches") {
  MissionWorld world = flatWorld(20.0);
  world.description.obstacles.push_back(sim::boxObstacle({3.0, 0.0, 0.0}, 0.4, 4.0, 1.0));
  Stage stage(world);
  stage.execution(5, execution_record_t::OUTCOME_RUNNING);
  auto motor = blank<motor_t>();
  motor.utime = stage.system.bus().now();
  motor.motor_run_id = 3;
  motor.execution_id = 5;
  stage.system.bus().outside().publish(kMotor, motor);
  stage.drive(0.6, 8.0);
  const MissionResult first = stage.referee.result();
  REQUIRE(first.collisions() == 1);
  CHECK(first.contacts[0].pattern == "straight");
  CHECK(first.contacts[0].T_map_body.x > 1.0);
  CHECK(first.contacts[0].T_map_body.x < 2.9);
  CHECK(first.contacts[0].penetration > 0.0);
  CHECK(first.contacts[0].time > 1.0);
  // Reversing and touching it again is another contact.
  stage.drive(-0.6, 3.0);
  stage.drive(0.6, 6.0);
  CHECK(stage.referee.result().collisions() == 2);
  CHECK(stage.referee.result().contacts[1].time > first.contacts[0].time + 3.0);
}

TEST_CASE("a change of surface is a crossing from when the robot came there, segments are whole") {
  MissionWorld world = flatWorld(30.0);
  world.description.regions.push_back(sim::stripRegion("grass", {4.0, 0.0}, {18.0, 0.0}, 20.0));
  Stage stage(world);
  stage.drive(0.8, 12.0);
  const MissionResult result = stage.referee.result();
  REQUIRE(result.crossings.size() >= 1);
  CHECK(result.crossings[0].from == "tarmac");
  CHECK(result.crossings[0].to == "grass");
  // The time is that of the border, not of its confirmation a second later.
  const auto before =
      std::find_if(result.track.begin(), result.track.end(),
                   [](const PoseSample& point) { return point.T_map_body.x > 4.0; });
  REQUIRE(before != result.track.end());
  CHECK(result.crossings[0].time == Approx(before->time).margin(0.35));
}

TEST_CASE("a surface counts once the robot has been on it for a second, from the start on") {
  SurfaceTracker tracker(0, "grass");
  CHECK_FALSE(tracker.step(1'000'000, "cinder"));
  CHECK_FALSE(tracker.step(1'950'000, "cinder"));
  CHECK(tracker.surface() == "grass");
  // An execution that may have crossed the border has no surface, even before it is confirmed.
  CHECK(tracker.between(500'000, 900'000) == "grass");
  CHECK(tracker.between(500'000, 1'500'000).empty());
  CHECK(tracker.step(2'000'000, "cinder") == 1'000'000);
  CHECK(tracker.surface() == "cinder");
  CHECK(tracker.between(1'100'000, 2'000'000) == "cinder");
  CHECK(tracker.between(900'000, 1'100'000).empty());
  // A short visit is no change.
  CHECK_FALSE(tracker.step(3'000'000, "grass"));
  CHECK_FALSE(tracker.step(3'900'000, "cinder"));
  CHECK_FALSE(tracker.step(4'100'000, "grass"));
  CHECK_FALSE(tracker.step(5'000'000, "grass"));
  CHECK(tracker.step(5'100'000, "grass") == 4'100'000);
  CHECK(tracker.between(3'200'000, 3'300'000) == "cinder");
}

TEST_CASE("arriving counts at the goal only, by the true pose") {
  Stage near(flatWorld(0.7));
  near.plan(plan_t::PLAN_ARRIVED);
  near.wait(0.2);
  CHECK(near.referee.ended());
  CHECK(near.referee.result().outcome == MissionOutcome::kArrived);
  CHECK(near.referee.result().reason.empty());
  Stage far(flatWorld(0.9));
  far.plan(plan_t::PLAN_ARRIVED);
  far.wait(0.2);
  CHECK(far.referee.ended());
  CHECK(far.referee.result().outcome == MissionOutcome::kStopped);
  CHECK(far.referee.result().reason.find("the true pose is outside") != std::string::npos);
}

TEST_CASE("a planner that is blocked for fifteen seconds without a break has refused") {
  Stage stage(flatWorld(20.0));
  stage.plan(plan_t::PLAN_BLOCKED, "a wall");
  stage.wait(10.0);
  stage.plan(plan_t::PLAN_DRIVING);
  stage.wait(0.1);
  stage.plan(plan_t::PLAN_UNREACHABLE, "no way to the goal");
  stage.wait(14.9);
  CHECK_FALSE(stage.referee.ended());
  stage.wait(0.5);
  CHECK(stage.referee.ended());
  CHECK(stage.referee.result().outcome == MissionOutcome::kRefused);
  CHECK(stage.referee.result().reason == "unreachable: no way to the goal");
}

TEST_CASE("a robot that does not move for a minute is idle, and the planner's words say why") {
  Stage stage(flatWorld(20.0));
  stage.plan(plan_t::PLAN_WAITING, "not armed");
  stage.wait(70.0);
  const MissionResult result = stage.referee.result();
  CHECK(result.outcome == MissionOutcome::kIdle);
  CHECK(result.reason.find("planner waiting: not armed") != std::string::npos);
  CHECK(result.time == Approx(60.0).margin(0.2));
  CHECK(result.begun == result.time);
  CHECK(result.stops.empty());
  CHECK(result.distance < 0.1);
}

TEST_CASE("each end of an execution counts once, and an abort is the reason of the stop after it") {
  Stage stage(flatWorld(30.0));
  stage.plan(plan_t::PLAN_DRIVING);
  stage.drive(0.6, 3.0);
  for (int repeat = 0; repeat < 3; ++repeat) {
    stage.execution(1, execution_record_t::OUTCOME_COMPLETED);
    stage.execution(2, execution_record_t::OUTCOME_ABORTED, "lease expired");
    stage.drive(0.6, 0.1);
  }
  stage.drive(0.0, 2.0);
  stage.drive(0.6, 2.0);
  const MissionResult result = stage.referee.result();
  CHECK(result.completed == 1);
  CHECK(result.aborted == 1);
  REQUIRE(result.stops.size() == 1);
  CHECK(result.stops[0].reason == "lease expired");
  CHECK(result.stops[0].duration > 0.5);
  CHECK(result.stops[0].duration < 2.5);
  CHECK(result.driven < result.time);
  CHECK(result.distance > 2.0);
}

TEST_CASE("a scored execution carries its surface, and a refused one why it was refused") {
  Stage stage(flatWorld(20.0));
  stage.wait(0.6);
  stage.execution(1, execution_record_t::OUTCOME_COMPLETED);
  auto learning = blank<learning_t>();
  learning.utime = stage.system.bus().now();
  learning.learned_run_id = 3;
  learning.learned_execution_id = 1;
  learning.learned_pattern_name = "straight";
  learning.accepted = true;
  learning.error_position = 0.25;
  learning.error_yaw = -0.1;
  learning.measured_end[2] = -0.5;
  Bus& bus = stage.system.bus().outside();
  stage.wait(0.05);
  bus.publish(kLearning, learning);
  learning.learned_execution_id = 2;  // without a record
  learning.accepted = false;
  learning.gate_reason = "too steep";
  bus.publish(kLearning, learning);
  stage.wait(0.05);
  const std::vector<ScoredExecution> scored = stage.referee.result().executions;
  REQUIRE(scored.size() == 2);
  CHECK(scored[0].measured);
  CHECK(scored[0].surface == "tarmac");
  CHECK(scored[0].error_position == 0.25);
  CHECK(scored[0].turned == 0.5);
  CHECK(scored[0].refusal.empty());
  CHECK_FALSE(scored[1].measured);
  CHECK(scored[1].refusal == "too steep");
  CHECK(scored[1].surface.empty());
}
