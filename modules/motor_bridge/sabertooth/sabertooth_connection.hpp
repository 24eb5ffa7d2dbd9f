// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/motor_bridge/core/controller_connection.hpp"

namespace tread::motor {

/// A Sabertooth two-channel controller in packet serial mode (Sabertooth 2x manuals, Packet
/// Serial).
struct SabertoothConfig {
  int address = 128;        ///< 128..135, of its switches
  double full_scale = 1.0;  ///< command that is full power
  int left_motor = 1;       ///< 1 or 2; the right track uses the other
  bool invert_left = false;
  bool invert_right = false;
  ConnectionTimes times;
};

/// Reads the section `sabertooth`; throws ConfigError with file:line.
SabertoothConfig readSabertoothConfig(ConfigReader& reader, const DriveDescription& drive);

/// A packet: address, command, value 0..127, and the sum of the three modulo 128.
std::string sabertoothPacket(int address, int command, int value);

/// The connection to a Sabertooth. It never answers: nothing can be verified.
/** Commands 0/1 and 4/5 drive motors 1 and 2 forwards/backwards (127 = full), 14 sets the serial
 * timeout, its watchdog, in steps of 0.1 s. The timeout is lost in a power cycle, and a restarted
 * controller waits for the bauding character 170; both are repeated every half second. A 170
 * before a packet is not part of it. */
class SabertoothConnection : public ControllerConnection {
 public:
  explicit SabertoothConnection(const SabertoothConfig& config)
      : ControllerConnection(config.times), config_(config) {}

  void receive(std::string_view bytes, int64_t now) override;
  void holdStop(bool /*hold*/) override {}
  void releaseStop(int64_t /*now*/) override {}
  MotorTelemetry telemetry() const override { return {}; }
  std::string notice() const override;

 private:
  enum Step { kBaud, kFirst, kTimeout, kZero, kSteps };

  std::string zero() const override { return commandBytes({}); }
  int startupSteps() const override { return kSteps; }
  std::string startupRequest(int step) const override;
  std::string startupName(int /*step*/) const override { return "start-up"; }
  bool isAnswered(int /*step*/) const override { return false; }
  void forget() override { output_.clear(); }
  void begin(int64_t now) override { set_up_at_ = now; }
  void give(const Command& command, int64_t now) override;
  std::string talk(int64_t now) override;
  std::string lost(int64_t /*now*/) const override { return ""; }
  DeviceReport reported(int64_t /*now*/) const override { return {}; }
  std::map<std::string, int64_t> counted() const override;

  std::string commandBytes(const TrackCommand& command) const;
  std::string setUp() const;

  SabertoothConfig config_;
  std::string output_;
  int64_t set_up_at_ = 0;
  int64_t commands_ = 0;
  int64_t unexpected_ = 0;
};

}  // namespace tread::motor
