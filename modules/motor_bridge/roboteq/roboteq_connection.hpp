// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
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

/// The connection to a Roboteq controller: starts it up, talks to it, notices when it is gone.
/** Bytes and time are arguments. Start-up at each (re)connect: echo off, watchdog set and read
    back, zero, firmware id. Commands leave only to a controller that was started up; on a faulty
    link zero is repeated until the next start-up. */
class RoboteqConnection : public MotorController {
 public:
  explicit RoboteqConnection(const RoboteqConfig& config) : config_(config), session_(config) {}

  void open() override;
  void close(const std::string& problem) override;
  bool isOpen() const override { return phase_ != Phase::kClosed; }
  void receive(std::string_view bytes, int64_t now) override;
  void command(const TrackCommand& command, int64_t now) override;
  void holdStop(bool hold) override { session_.holdStop(hold); }
  void releaseStop(int64_t now) override { session_.releaseStop(now); }
  std::string poll(int64_t now) override;
  std::string zeros(int times) const override;
  DeviceReport report(int64_t now) const override;
  bool ready() const override { return phase_ == Phase::kReady; }
  MotorTelemetry telemetry() const override { return known(); }
  const std::string& firmware() const { return firmware_; }
  std::string lineProblem() const override;
  std::map<std::string, int64_t> counters() const override;

 private:
  /// How many exchanges there were until a time, and how many of them failed.
  struct Exchanges {
    int64_t utime = 0;  ///< [us]
    int64_t all = 0;
    int64_t failed = 0;
  };
  enum class Phase { kClosed, kEcho, kWatchdog, kReadBack, kZero, kIdentify, kReady, kBackoff };

  RoboteqTelemetry known() const { return ready() ? session_.telemetry() : RoboteqTelemetry{}; }
  void enter(Phase phase);
  Exchanges exchanges(int64_t now) const;
  void watchLine(int64_t now);
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
  std::deque<Exchanges> line_;  ///< of the last seconds
  int tries_ = 0;               ///< of the present request
  int64_t asked_at_ = 0;        ///< when the present request was sent
  int64_t backoff_us_ = 0;
  int64_t retry_at_ = 0;
  int64_t zero_at_ = 0;  ///< last zero sent outside of a session
};

}  // namespace tread::motor
