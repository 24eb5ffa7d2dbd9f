// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/motor_bridge_config.hpp"

#include "common/vehicle/robot_file.hpp"
#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"

namespace tread::motor {
namespace {

MakeMotorController roboteq(ConfigReader section, const DriveDescription& drive) {
  const RoboteqConfig config = readRoboteqConfig(section, drive);
  return [config] { return std::make_unique<RoboteqConnection>(config); };
}

/// A new controller is one line here and a folder of its own.
const std::map<std::string, MakeMotorController (*)(ConfigReader, const DriveDescription&)>
    kControllers{{"roboteq", roboteq}};

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

MakeMotorController readMotorController(ConfigReader& reader, const DriveDescription& drive) {
  std::vector<std::string> known;
  for (const auto& [name, read] : kControllers) known.push_back(name);
  std::string name = "roboteq";
  reader.choice("controller", name, known);
  return kControllers.at(name)(reader.section(name), drive);
}

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
