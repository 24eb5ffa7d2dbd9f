// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "modules/motor_bridge/core/controller_connection.hpp"
#include "modules/motor_bridge/core/pending_replies.hpp"
#include "modules/motor_bridge/vesc/vesc_group.hpp"

namespace tread::motor {

/// Common part of the connections to VESC controllers over UART and over CAN.
/** Only commands feed the controllers' timeout, which is their watchdog: COMM_ALIVE, which would
 * keep motors running without commands, is not used. They have no latching emergency stop. */
class VescConnection : public ControllerConnection {
 public:
  void holdStop(bool /*hold*/) override {}
  void releaseStop(int64_t /*now*/) override {}
  MotorTelemetry telemetry() const override {
    return ready() ? group_.telemetry() : MotorTelemetry{};
  }

 protected:
  explicit VescConnection(const VescConfig& config)
      : ControllerConnection(config.times), config_(config), group_(config) {}

  /// A command addressed to one controller.
  virtual std::string addressed(int id, const VescCommand& command) const = 0;

  std::string commandBytes(const Command& command) const;
  std::string zero() const override { return commandBytes({}); }
  void begin(int64_t now) override;
  void give(const Command& command, int64_t now) override;
  std::string lost(int64_t now) const override;
  DeviceReport reported(int64_t now) const override;

  VescConfig config_;
  VescGroup group_;
  std::string output_;
  int64_t commands_ = 0;
};

/// VESC controllers behind one UART; the others are reached through the one on the line.
/** Start-up: zero, firmware of each, timeout of each (COMM_GET_APPCONF): it must be set in VESC
 * Tool, at most to the configured watchdog. */
class VescUart : public VescConnection {
 public:
  explicit VescUart(const VescConfig& config) : VescConnection(config) {}

  void receive(std::string_view bytes, int64_t now) override;

 private:
  int startupSteps() const override { return 2 * count() + 2; }
  std::string startupRequest(int step) const override;
  std::string startupName(int step) const override;
  bool isAnswered(int step) const override { return step > 0 && step <= 2 * count(); }
  void forget() override;
  void begin(int64_t now) override;
  std::string talk(int64_t now) override;
  std::map<std::string, int64_t> counted() const override;
  std::string addressed(int id, const VescCommand& command) const override;

  int count() const { return static_cast<int>(config_.ids().size()); }
  /// The controller of an answered step of the start-up.
  int idOf(int step) const { return config_.ids()[static_cast<size_t>((step - 1) % count())]; }
  std::string toController(int id, std::string_view payload) const;
  void takeStartup(const std::string& payload, int64_t now);
  void checkTimeout(const VescTimeout& told, int64_t now);

  VescPackets packets_;
  PendingReplies pending_;
  size_t next_query_ = 0;
  int64_t queried_at_ = 0;
  int64_t unreadable_ = 0;
};

/// VESC controllers on a CAN bus, as a stream of struct can_frame. They must be configured to send
/// STATUS, STATUS_4 and STATUS_5 (VESC Tool: CAN Status Messages), at 20 Hz or more.
class VescCan : public VescConnection {
 public:
  explicit VescCan(const VescConfig& config) : VescConnection(config) {}

  void receive(std::string_view bytes, int64_t now) override;
  std::string notice() const override;

 private:
  enum Step { kZero, kListen, kLastZero, kSteps };

  int startupSteps() const override { return kSteps; }
  std::string startupRequest(int /*step*/) const override { return zero(); }
  std::string startupName(int step) const override;
  bool isAnswered(int step) const override { return step == kListen; }
  void forget() override;
  std::string talk(int64_t now) override;
  std::map<std::string, int64_t> counted() const override;
  std::string addressed(int id, const VescCommand& command) const override {
    return vescFrame(id, command);
  }

  VescFrames frames_;
};

}  // namespace tread::motor
