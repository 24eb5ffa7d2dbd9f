// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "modules/motor_bridge/core/controller_connection.hpp"
#include "modules/motor_bridge/core/line_cutter.hpp"
#include "modules/motor_bridge/core/pending_replies.hpp"
#include "modules/motor_bridge/line_protocol/line_description.hpp"

namespace tread::motor {

/// The connection to a controller whose line protocol is described in YAML.
/** Start-up: zero, the described requests, zero. A reply that reads the watchdog back must contain
 * the configured value. */
class LineConnection : public ControllerConnection {
 public:
  explicit LineConnection(const LineDescription& line);

  void receive(std::string_view bytes, int64_t now) override;
  void holdStop(bool hold) override;
  void releaseStop(int64_t now) override;
  MotorTelemetry telemetry() const override { return ready() ? telemetry_ : MotorTelemetry{}; }
  std::string notice() const override;

 private:
  std::string zero() const override;
  int startupSteps() const override { return static_cast<int>(line_.start.size()) + 2; }
  std::string startupRequest(int step) const override;
  std::string startupName(int step) const override;
  bool isAnswered(int step) const override;
  void forget() override;
  void begin(int64_t now) override;
  void give(const Command& command, int64_t now) override;
  std::string talk(int64_t now) override;
  std::string lost(int64_t now) const override;
  DeviceReport reported(int64_t now) const override;
  std::map<std::string, int64_t> counted() const override;

  const LineExchange* exchangeOf(int step) const;
  LineValues commandValues(const Command& command) const;
  void sendCommand(const std::string& line, int64_t now);
  void takeLine(const std::string& line, int64_t now);
  void takeStartup(const std::string& line, int64_t now);
  bool refuses(const std::string& line) const;
  void takeReply(const std::string& line, int64_t now);
  bool isWatchdog(const LineTemplate& reply, double counts) const;
  void takeValues(const LineTemplate& reply, const LineValues& values, int64_t now);
  void pollStop(int64_t now);
  void pollQuery(int64_t now);
  bool readsFaults() const;

  LineDescription line_;
  LineCutter lines_;
  PendingReplies pending_;
  std::string output_;
  MotorTelemetry telemetry_;
  std::string problem_;
  int64_t heard_at_ = 0;
  std::optional<int64_t> faults_read_at_;  ///< [us]
  size_t next_query_ = 0;
  int64_t queried_at_ = 0;
  int watchdog_mismatches_ = 0;
  Command given_;
  bool repeat_ = false;  ///< the last command was refused
  bool latched_ = false;
  bool hold_stop_ = false;
  int64_t release_until_ = 0;
  int64_t stop_sent_at_ = 0;
  int64_t bad_checksums_ = 0;
  int64_t unreadable_ = 0;
};

}  // namespace tread::motor
