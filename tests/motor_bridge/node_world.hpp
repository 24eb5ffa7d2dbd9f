// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/bus/virtual_bus.hpp"
#include "common/link/make_link.hpp"
#include "common/messages/operator_beacon.hpp"
#include "modules/motor_bridge/motor_bridge_node.hpp"
#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"
#include "tests/motor_bridge/driven_robot.hpp"
#include "tests/motor_bridge/endless_planner.hpp"
#include "tests/motor_bridge/messages.hpp"
#include "tests/motor_bridge/scripted_roboteq.hpp"

namespace tread::motor {

/// The planner's side of the bus: EXECUTION in, PROGRAM out at 20 Hz.
class PlannerNode : public Node {
 public:
  explicit PlannerNode(Bus& bus) : bus_(bus), planner(bus.bootId()) {
    bus_.subscribe<execution_t>(kExecution,
                                [this](const execution_t& message) { last_ = newest(message); });
  }
  int64_t period() const override { return 50'000; }
  void step(int64_t utime) override {
    bus_.publish(kProgram, toMessage(planner.plan(utime, last_)));
  }

 private:
  Bus& bus_;
  std::optional<ExecutionRecord> last_;

 public:
  EndlessPlanner planner;
};

/// An INS at 50 Hz with 8 ms latency.
class InsNode : public Node {
 public:
  InsNode(Bus& bus, DrivenRobot& robot) : bus_(bus), robot_(robot) {}
  int64_t period() const override { return 20'000; }
  void step(int64_t utime) override { bus_.publish(kIns, robot_.measured(utime - 8'000, seq_++)); }

 private:
  Bus& bus_;
  DrivenRobot& robot_;
  int64_t seq_ = 0;
};

/// The remote operator.
class OperatorNode : public Node {
 public:
  explicit OperatorNode(Bus& bus) : beacon_(bus, "operator") {}
  int64_t period() const override { return 20'000; }
  void step(int64_t utime) override { beacon_.step(utime); }
  /// Ends in good order.
  void shutdown(int64_t utime) override { beacon_.letGo(utime); }

 private:
  OperatorBeacon beacon_;
};

/// The controller at the other end of the line, stepped every millisecond.
class ControllerNode : public Node {
 public:
  ControllerNode(ScriptedRoboteq& device, Link& link, std::vector<int64_t>& moving,
                 DrivenRobot& robot)
      : device_(device), link_(link), moving_(moving), robot_(robot) {}
  int64_t period() const override { return 1'000; }
  void step(int64_t utime) override {
    uint8_t buffer[512];
    std::string heard;
    if (link_.isOpen() || link_.reopen(utime)) {
      while (const std::optional<size_t> size = link_.read(buffer, sizeof buffer)) {
        if (*size == 0) break;
        heard.append(reinterpret_cast<const char*>(buffer), *size);
      }
    }
    device_.write(heard, utime);
    const std::string said = device_.read();
    if (!said.empty()) link_.write(reinterpret_cast<const uint8_t*>(said.data()), said.size());
    if (!device_.stands(utime)) moving_.push_back(utime);
    robot_.follow(device_.motor1(utime), device_.motor2(utime), utime);
  }

 private:
  ScriptedRoboteq& device_;
  Link& link_;
  std::vector<int64_t>& moving_;
  DrivenRobot& robot_;
};

/// All peers of motor_bridge on the virtual bus.
struct NodeWorld {
  ScriptedRoboteq device;
  std::vector<int64_t> moving;  ///< times at which the motors turned [us]
  DrivenRobot robot;
  std::pair<std::unique_ptr<Link>, std::unique_ptr<Link>> pipe = makePipe();
  VirtualBus bus;
  motor_t motor{};
  execution_t execution{};
  health_t health{};
  fences_t fences{};
  config_t config{};
  int64_t motors = 0;
  int64_t executions = 0;

  /// With a key all processes have it, including the operator's.
  explicit NodeWorld(uint64_t seed = 1, const FaultPlan& faults = {}, const NodeTiming& timing = {},
                     std::optional<SealKey> key = {})
      : bus(seed, faults) {
    if (key) bus.useKey(*key);
    bus.addNode("controller", [this](Bus&) {
      return std::make_unique<ControllerNode>(device, *pipe.second, moving, robot);
    });
    bus.addNode(
        "motor_bridge",
        [this](Bus& end) {
          MotorBridgeConfig usual;
          usual.bridge.tilt = TiltLimits{0.5, 0.5};
          usual.make_controller = [] {
            return std::make_unique<RoboteqConnection>(RoboteqConfig{});
          };
          return std::make_unique<MotorBridgeNode>(usual, end, *pipe.first);
        },
        timing);
    bus.addNode("planner", [](Bus& end) { return std::make_unique<PlannerNode>(end); },
                {3'000, 1'000});
    bus.addNode("ins", [this](Bus& end) { return std::make_unique<InsNode>(end, robot); });
    bus.addNode("operator", [](Bus& end) { return std::make_unique<OperatorNode>(end); });
    watch();
  }

  void watch() {
    Bus& outside = bus.outside();
    outside.subscribe<motor_t>(kMotor, [this](const motor_t& m) {
      motor = m;
      ++motors;
    });
    outside.subscribe<execution_t>(kExecution, [this](const execution_t& m) {
      execution = m;
      ++executions;
    });
    outside.subscribe<health_t>(kHealth, [this](const health_t& m) { health = m; });
    outside.subscribe<fences_t>(kFences, [this](const fences_t& m) {
      if (m.keeper == "motor_bridge") fences = m;
    });
    outside.subscribe<config_t>(kConfig, [this](const config_t& m) { config = m; });
  }

  int64_t now() const { return bus.now(); }
  void run(int64_t us) { bus.runUntil(bus.now() + us); }
  void say(bool armed) {
    arm_t message{};
    message.utime = now();
    message.armed = armed;
    message.armed_by = "operator";
    bus.outside().publish(kArm, message);
  }
  void estop(bool engaged) {
    estop_t message{};
    message.utime = now();
    message.engaged = engaged;
    message.estop_by = "operator";
    message.estop_reason = "person in front";
    bus.outside().publish(kEstop, message);
  }
  /// Runs until the motors turn.
  void drive() {
    run(1'700'000);
    say(true);
    run(300'000);
  }
  bool drives() const { return motor.bridge_state == motor_t::STATE_DRIVING && stoodFor() < 5'000; }
  /// Time since the motors last turned [us].
  int64_t stoodFor() const { return moving.empty() ? INT64_MAX : now() - moving.back(); }
  /// Runs for a time; returns the last motion of the motors, relative to its beginning [us].
  int64_t lastMotionWithin(int64_t us) {
    const int64_t begin = now();
    run(us);
    return moving.empty() ? 0 : std::max<int64_t>(0, moving.back() - begin);
  }
  MotorBridgeNode& bridge() { return *static_cast<MotorBridgeNode*>(bus.node("motor_bridge")); }
  PlannerNode& planner() { return *static_cast<PlannerNode*>(bus.node("planner")); }
  int64_t counter(const std::string& name) const {
    for (const counter_t& counter : health.counters) {
      if (counter.counter_name == name) return counter.counted;
    }
    return 0;
  }
};

}  // namespace tread::motor
