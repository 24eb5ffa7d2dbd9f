// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/motor_bridge_config.hpp"

#include "common/vehicle/robot_file.hpp"

namespace tread::motor {
namespace {

void readTimes(ConfigReader& reader, BridgeConfig& bridge) {
  reader.seconds("step", bridge.step_us, {0.001, 0.02});
  reader.seconds("command_interval", bridge.command_interval_us, {0.01, 0.05});
  reader.seconds("lease", bridge.gate.lease_us, {0.05, 0.2});
  reader.seconds("ins_period", bridge.ins.period_us, {0.002, 0.1});
  reader.seconds("ins_max_latency", bridge.ins.max_latency_us, {0.0, 0.5});
  if (bridge.command_interval_us % bridge.step_us != 0) {
    throw reader.error("command_interval", "must be a multiple of step");
  }
  bridge.gate.slot.step_us = bridge.step_us;
}

void takeDrive(const DriveDescription& drive, MotorBridgeConfig& config) {
  SlotLimits& slot = config.bridge.gate.slot;
  slot.kind = drive.kind;
  slot.max_command = drive.max_command;
  RoboteqLayout& layout = config.controller.layout;
  layout.full_scale = drive.fullCommand();
  layout.left_channel = drive.left_channel;
  layout.invert_left = drive.invert_left;
  layout.invert_right = drive.invert_right;
}

void readRoboteq(ConfigReader reader, RoboteqConfig& controller) {
  RoboteqLayout& layout = controller.layout;
  int64_t watchdog_us = 1000 * controller.watchdog_ms;
  // Zero is repeated every 0.1 s: a shorter watchdog would expire while the robot stands.
  reader.seconds("watchdog", watchdog_us, {0.15, 0.25});
  controller.watchdog_ms = watchdog_us / 1000;
  reader.flag("both_in_one_line", layout.both_in_one_line);
  reader.number("rpm_per_mps", layout.rpm_per_mps, {0.0, 100000.0}, "rpm s/m");
}

}  // namespace

MotorBridgeConfig readMotorBridgeConfig(ConfigReader& reader) {
  MotorBridgeConfig config;
  reader.choice("controller", config.kind, {"roboteq"});
  reader.text("address", config.address);
  readTimes(reader, config.bridge);
  takeDrive(readRobot(reader).drive, config);
  readRoboteq(reader.section("roboteq"), config.controller);
  reader.finish();
  config.effective = reader.effective();
  return config;
}

}  // namespace tread::motor
