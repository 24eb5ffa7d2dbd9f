// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/motor_bridge/roboteq/roboteq_session.hpp"

namespace tread::motor {

/// Reads the section `roboteq` of the bridge's configuration; wiring and full scale are the
/// robot's.
RoboteqConfig readRoboteqConfig(ConfigReader& reader, const DriveDescription& drive);

/// The connection to a Roboteq controller: start-up, dialogue, detection of its loss.
/** Start-up: echo off, watchdog set and read back, zero, firmware id. */
class RoboteqConnection : public ControllerConnection {
 public:
  explicit RoboteqConnection(const RoboteqConfig& config);

  void receive(std::string_view bytes, int64_t now) override;
  void holdStop(bool hold) override { session_.holdStop(hold); }
  void releaseStop(int64_t now) override { session_.releaseStop(now); }
  MotorTelemetry telemetry() const override { return known(); }
  const std::string& firmware() const { return firmware_; }

 private:
  enum Step { kEcho, kWatchdog, kReadBack, kZero, kIdentify, kSteps };

  std::string zero() const override;
  int startupSteps() const override { return kSteps; }
  std::string startupRequest(int step) const override;
  std::string startupName(int step) const override;
  void forget() override { lines_.clear(); }
  void begin(int64_t now) override { session_.begin(now); }
  void give(const Command& command, int64_t now) override { session_.give(command.tracks(), now); }
  std::string talk(int64_t now) override { return session_.poll(now); }
  std::string lost(int64_t /*now*/) const override { return session_.problem(); }
  DeviceReport reported(int64_t now) const override;
  std::map<std::string, int64_t> counted() const override;

  RoboteqTelemetry known() const { return ready() ? session_.telemetry() : RoboteqTelemetry{}; }
  void takeLine(const std::string& line, int64_t now);
  void takeStartup(const RoboteqReply& reply, int64_t now);
  void checkWatchdog(const RoboteqReply& reply, int64_t now);

  RoboteqConfig config_;
  RoboteqSession session_;
  LineCutter lines_;
  std::string firmware_;
};

}  // namespace tread::motor
