// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>
#include <string>

#include <tread/execution_record_t.hpp>
#include <tread/ins_t.hpp>
#include <tread/manual_t.hpp>
#include <tread/motor_t.hpp>
#include <tread/operator_t.hpp>
#include <tread/program_t.hpp>

#include "common/bus/bus.hpp"
#include "common/config/config_reader.hpp"
#include "common/link/link.hpp"
#include "common/messages/fence_messages.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/motor_bridge/core/bridge.hpp"
#include "modules/motor_bridge/core/command_periods.hpp"
#include "modules/motor_bridge/core/motor_controller.hpp"
#include "modules/motor_bridge/motor_controllers.hpp"

namespace tread::motor {

/// Configuration of motor_bridge, with its defaults.
struct MotorBridgeConfig {
  std::string address = "tty:/dev/ttyACM0?baud=115200";  ///< of the controller
  BridgeConfig bridge;
  std::string controller = "roboteq";   ///< the kind that the configuration names
  MakeMotorController make_controller;  ///< of that kind
  std::string effective;                ///< the whole as YAML, for CONFIG
};

/// Reads the configuration; throws ConfigError with file:line.
/** No value disables a safeguard: the lease, the INS limit and the controller's watchdog can only
 * be stricter than their defaults, or slightly longer where the hardware needs it. */
MotorBridgeConfig readMotorBridgeConfig(ConfigReader& reader);

/// Conversion from a message to the core's types. Unchecked, because the gate checks them.
Program fromMessage(const program_t& message);
InsNotice fromMessage(const ins_t& message);
ManualNotice fromMessage(const manual_t& message);

/// One record of EXECUTION.
execution_record_t toMessage(const ExecutionRecord& record);
/// MOTOR, without utime and seq.
motor_t toMessage(const BridgeOutput& output, const MotorTelemetry& telemetry, size_t channels);

/// The motor_bridge process. PROGRAM, OPERATOR, MANUAL, ARM, ESTOP, INS in; the controller, MOTOR,
/// EXECUTION, HEALTH, CONFIG out.
/** The only process that may move the motors, and the only one that compares utime with the host
 * clock: its bus's now() must be CLOCK_MONOTONIC. It steps every 10 ms, so that series of 50 ms
 * begin, change and end on a step. */
class MotorBridgeNode : public Node {
 public:
  MotorBridgeNode(const MotorBridgeConfig& config, Bus& bus, Link& link);

  int64_t period() const override { return config_.bridge.step_us; }
  void step(int64_t utime) override;
  /// Disarms and sends zero several times: a lost byte must not leave the motors running.
  void shutdown(int64_t utime) override;

  const Bridge& bridge() const { return bridge_; }
  /// What cannot be verified with this controller, one line; empty = nothing.
  std::string notice() const { return controller_->notice(); }

 private:
  void listen();
  void take(const operator_t& message);
  void readLink(int64_t utime);
  void writeLink(const std::string& bytes, int64_t utime);
  void drive(int64_t utime);
  void publishMotor(int64_t utime);
  void publishExecutions(int64_t utime);
  void publishStopping(int64_t utime);
  void reportHealth();
  void reportCounters(int64_t utime);
  void reportDevice();

  MotorBridgeConfig config_;
  Bus& bus_;
  Link& link_;
  Bridge bridge_;
  std::unique_ptr<MotorController> controller_;
  CommandPeriods periods_;
  HealthReporter health_;
  FenceExchange fence_exchange_;
  std::string holder_;      ///< as published
  BridgeOutput output_;     ///< of this step
  BridgeOutput published_;  ///< of the last MOTOR
  uint64_t published_revision_ = 0;
  int64_t seq_motor_ = 0;
  int64_t seq_execution_ = 0;
  int64_t next_motor_ = 0;
  int64_t next_execution_ = 0;
  int64_t next_stopping_ = 0;
  int64_t seq_stopping_ = 0;
  int64_t next_counters_ = 0;
  int64_t next_open_ = 0;
};

}  // namespace tread::motor
