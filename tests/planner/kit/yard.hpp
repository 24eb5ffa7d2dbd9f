// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "common/bus/virtual_bus.hpp"
#include "common/messages/operator_beacon.hpp"
#include "modules/planner/planner_node.hpp"
#include "tests/planner/kit/toy_robot.hpp"
#include "tests/planner/kit/vehicle.hpp"

namespace tread::planner::testkit {

/// The planner node and a toy robot on a virtual bus, with subscriptions of the test.
struct Yard {
  explicit Yard(FaultPlan faults = {}, const PlannerConfig& config = usualPlanner())
      : bus(7, std::move(faults)), start(bus.now()), beacon(bus.outside(), "test") {
    beacon.standFor(goal_id);
    bus.addNode("robot", [](Bus& end) { return std::make_unique<ToyRobot>(end); });
    bus.addNode(
        "planner",
        [this, config](Bus& end) { return std::make_unique<PlannerNode>(config, end, &store); },
        {8'000, 3'000});
    bus.outside().subscribe<plan_t>(kPlan, [this](const plan_t& message) {
      plan = message;
      ++plans;
    });
    bus.outside().subscribe<plan_tree_t>(kPlanTree,
                                         [this](const plan_tree_t& message) { tree = message; });
    bus.outside().subscribe<program_t>(kProgram, [this](const program_t& message) {
      longest_silence = std::max(longest_silence, message.utime - last_program);
      last_program = message.utime;
      ++programs;
      if (message.running.execution_id != 0) run_id = message.run_id;
    });
    bus.outside().subscribe<fences_t>(kFences, [this](const fences_t& message) {
      if (message.keeper == "planner") fences = message;
    });
    bus.outside().subscribe<health_t>(kHealth, [this](const health_t& message) {
      if (message.process == "planner") health = message;
    });
  }

  void sendGoal(double x, double tolerance = 0.5) {
    goal_ = {x, tolerance};
    goal_t message{};
    message.utime = bus.now();
    message.seq = seq++;
    message.goal_id = goal_id;
    message.goal_pose[0] = x;
    message.position_tolerance = tolerance;
    message.yaw_tolerance = 4.0;
    bus.outside().publish(kGoal, message);
  }

  void arm(bool armed = true, const std::string& by = "test") {
    arm_t message{};
    message.utime = bus.now();
    message.seq = seq++;
    message.armed = armed;
    message.armed_by = by;
    bus.outside().publish(kArm, message);
  }
  /// Arms and repeats the last goal, which is valid only after the arming.
  void armAndGo() {
    arm();
    run(0.2);
    renewGoal();
    sendGoal(goal_.x(), goal_.y());
  }

  void estop(bool engaged) {
    estop_t message{};
    message.utime = bus.now();
    message.seq = seq++;
    message.engaged = engaged;
    bus.outside().publish(kEstop, message);
  }

  /// Gives the following goals a new id.
  void renewGoal() { beacon.standFor(++goal_id); }

  void run(double seconds) {
    const int64_t end = bus.now() + static_cast<int64_t>(seconds * 1e6);
    while (bus.now() < end) {
      if (operator_there) beacon.step(bus.now());
      bus.runUntil(std::min<int64_t>(end, bus.now() + 50'000));
    }
  }
  ToyRobot& robot() { return *dynamic_cast<ToyRobot*>(bus.node("robot")); }

  MemoryStore store;  ///< of the planner, which it outlives
  VirtualBus bus;
  int64_t start;
  OperatorBeacon beacon;
  int64_t goal_id = 1;
  Eigen::Vector2d goal_{0.0, 0.5};  ///< [m] last goal's x and tolerance
  bool operator_there = true;
  int64_t seq = 0;
  plan_t plan{};
  plan_tree_t tree{};
  health_t health{};
  fences_t fences{};
  int plans = 0;
  int programs = 0;
  int64_t run_id = 0;
  int64_t last_program = 0;
  int64_t longest_silence = 0;
};

}  // namespace tread::planner::testkit
