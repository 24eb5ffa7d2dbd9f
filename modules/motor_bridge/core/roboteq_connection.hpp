// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "modules/motor_bridge/core/device_report.hpp"
#include "modules/motor_bridge/core/roboteq_codec.hpp"
#include "modules/motor_bridge/core/roboteq_session.hpp"

namespace tread::motor {

/// The connection to a Roboteq controller: starts it up, talks to it, notices when it is gone.
/** Bytes and time are arguments. Start-up at each (re)connect: echo off, watchdog set and read
    back, zero, firmware id. Commands leave only to a controller that was started up; on a faulty
    link zero is repeated until the next start-up. */
class RoboteqConnection {
 public:
  explicit RoboteqConnection(const RoboteqConfig& config) : config_(config), session_(config) {}

  /// The line was opened: start-up begins.
  void open();
  /// The line is gone or full.
  void close(const std::string& problem);
  bool isOpen() const { return phase_ != Phase::kClosed; }

  /// Bytes from the controller, received at now [us].
  void receive(std::string_view bytes, int64_t now);
  /// A command to be given now [us]; dropped unless the controller is ready.
  void command(const TrackCommand& command, int64_t now);
  /// See RoboteqSession.
  void holdStop(bool hold) { session_.holdStop(hold); }
  void releaseStop(int64_t now) { session_.releaseStop(now); }
  /// Timeouts, queries and start-up; returns all bytes to be written now [us].
  std::string poll(int64_t now);

  /// Is the controller fit to be given commands?
  DeviceReport report(int64_t now) const;
  bool ready() const { return phase_ == Phase::kReady; }
  /// Unknown unless ready.
  RoboteqTelemetry telemetry() const { return ready() ? session_.telemetry() : RoboteqTelemetry{}; }
  const std::string& firmware() const { return firmware_; }
  /// What was counted, by its name in words.
  std::map<std::string, int64_t> counters() const;

 private:
  enum class Phase { kClosed, kEcho, kWatchdog, kReadBack, kZero, kIdentify, kReady, kBackoff };

  void enter(Phase phase);
  void fail(const std::string& problem, int64_t now, const std::string& detail = "");
  void send(const std::string& line) { output_ += line + "\r"; }
  void sendZero(int64_t now);
  std::string request() const;
  void pollStartup(int64_t now);
  void takeStartup(const RoboteqReply& reply, int64_t now);
  void checkWatchdog(const RoboteqReply& reply, int64_t now);
  void advance(int64_t now);

  RoboteqConfig config_;
  RoboteqSession session_;
  Phase phase_ = Phase::kClosed;
  std::string problem_ = "not opened yet";
  RoboteqLines lines_;
  std::string output_;
  std::string firmware_;
  std::map<std::string, int64_t> counters_;
  int tries_ = 0;         ///< of the present request
  int64_t asked_at_ = 0;  ///< when the present request was sent
  int64_t backoff_us_ = 0;
  int64_t retry_at_ = 0;
  int64_t zero_at_ = 0;  ///< last zero sent outside of a session
};

}  // namespace tread::motor
