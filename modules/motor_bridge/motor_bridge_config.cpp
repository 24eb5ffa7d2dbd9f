// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/motor_bridge_config.hpp"

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

void readCommands(ConfigReader& reader, MotorBridgeConfig& config) {
  SlotLimits& slot = config.bridge.gate.slot;
  RoboteqLayout& layout = config.controller.layout;
  std::string kind = "power";
  reader.choice("command_kind", kind, {"power", "track_speed"});
  slot.kind = kind == "power" ? CommandKind::kPower : CommandKind::kTrackSpeed;
  // Power is a share of full power, so its full scale is 1; a track speed has one of its own.
  const bool speed = slot.kind == CommandKind::kTrackSpeed;
  reader.number("full_scale", layout.full_scale, {speed ? 0.05 : 1.0, speed ? 20.0 : 1.0},
                speed ? "m/s" : "1", speed);
  slot.max_command = layout.full_scale;
  reader.number("max_command", slot.max_command, {0.0, layout.full_scale}, speed ? "m/s" : "1");
}

void readController(ConfigReader reader, RoboteqConfig& controller) {
  RoboteqLayout& layout = controller.layout;
  int64_t watchdog_us = 1000 * controller.watchdog_ms;
  // Zero is repeated every 0.1 s: a shorter watchdog would expire while the robot stands.
  reader.seconds("watchdog", watchdog_us, {0.15, 0.25});
  controller.watchdog_ms = watchdog_us / 1000;
  reader.flag("both_in_one_line", layout.both_in_one_line);
  int64_t left_channel = layout.left_channel;
  reader.integer("left_channel", left_channel, {1, 2}, "1");
  layout.left_channel = static_cast<int>(left_channel);
  reader.flag("invert_left", layout.invert_left);
  reader.flag("invert_right", layout.invert_right);
  reader.number("rpm_per_mps", layout.rpm_per_mps, {0.0, 100000.0}, "rpm s/m");
}

}  // namespace

MotorBridgeConfig readMotorBridgeConfig(ConfigReader& reader) {
  MotorBridgeConfig config;
  reader.text("address", config.address);
  readTimes(reader, config.bridge);
  readCommands(reader, config);
  readController(reader.section("controller"), config.controller);
  reader.finish();
  config.effective = reader.effective();
  return config;
}

}  // namespace tread::motor
