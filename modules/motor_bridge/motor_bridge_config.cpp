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
  if (bridge.command_interval_us % bridge.step_us != 0)
    throw reader.error("command_interval", "must be a multiple of step");
  bridge.gate.slot.step_us = bridge.step_us;
}

}  // namespace

MotorBridgeConfig readMotorBridgeConfig(ConfigReader& reader) {
  MotorBridgeConfig config;
  reader.text("address", config.address);
  readTimes(reader, config.bridge);
  const DriveDescription drive = readRobot(reader).drive;
  config.bridge.gate.slot.kind = drive.kind;
  config.bridge.gate.slot.max_command = drive.max_command;
  config.make_controller = readMotorController(reader, drive);
  reader.finish();
  config.effective = reader.effective();
  return config;
}

}  // namespace tread::motor
