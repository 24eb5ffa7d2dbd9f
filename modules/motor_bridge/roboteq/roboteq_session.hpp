// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "modules/motor_bridge/core/controller_connection.hpp"
#include "modules/motor_bridge/core/line_cutter.hpp"
#include "modules/motor_bridge/core/pending_replies.hpp"

namespace tread::motor {

/// How the two tracks are connected to a Roboteq dual-channel controller.
struct RoboteqLayout {
  bool both_in_one_line = true;  ///< "!M l r" moves both tracks at once; false: two "!G cc n" lines
  int left_channel = 1;          ///< 1 or 2; the right track uses the other
  bool invert_left = false;      ///< the left motor is mounted in reverse
  bool invert_right = false;
  double full_scale = 1.0;   ///< command that is 1000 per mille, in the units of the command kind
  double rpm_per_mps = 0.0;  ///< motor revolutions per minute at 1 m/s of track; 0 = no encoders
};

/// Command in per mille of full scale by channel, clamped to the controller's range.
struct ChannelCommand {
  int channel_1 = 0;
  int channel_2 = 0;
};

/// Track command to channels. NaN becomes zero: this is the last check.
ChannelCommand toChannels(const TrackCommand& command, const RoboteqLayout& layout);
/// Lines (without CR) that give a command to the controller.
std::vector<std::string> commandLines(const TrackCommand& command, const RoboteqLayout& layout);

/// One reply of the controller.
struct RoboteqReply {
  enum class Kind { kAck, kRefused, kValue, kOther };
  Kind kind = Kind::kOther;
  std::string key;           ///< e.g. "A" of "A=100:200"
  std::vector<long> values;  ///< empty if the value is text, as in FID
  std::string text;          ///< everything after the equals sign
};

/// Whether a line is an echo of ours: the controller's own lines never begin like this.
bool isEcho(const std::string& line);
/// Parses one line; unknown ones are kOther.
RoboteqReply parseReply(const std::string& line);

/// Runtime fault flags of query ?FF (Roboteq manual, maintenance and runtime queries).
enum FaultFlag : int32_t {
  kOverheat = 1,
  kOvervoltage = 2,
  kUndervoltage = 4,
  kShortCircuit = 8,
  kEmergencyStop = 16,
  kSensorSetup = 32,
  kMosfetFailure = 64,
  kDefaultConfiguration = 128,
};

/// Relevant status flags of query ?FS; the others describe the command mode.
enum StatusFlag : int32_t {
  kPowerStageOff = 8,
  kStallDetected = 16,
  kAtLimit = 32,
};

/// Status flags that stop the robot.
inline constexpr int32_t kStoppingStatus = kPowerStageOff | kStallDetected;

/// Flags of one motor (query ?FM) that stop the robot; the others report active limits.
enum MotorFlag : int32_t {
  kMotorStall = 2,
  kLoopError = 4,
  kSafetyStop = 8,
};

/// Such flags in words, e.g. "left motor: stall"; empty if nothing stops the robot.
std::string describeMotorFaults(const std::string& side, int32_t motor_flags);

/// Flags in words, e.g. "controller: overheat, undervoltage"; empty if nothing stops the robot.
std::string describeFaults(int32_t fault_flags, int32_t status_flags);

/// The controller's latest data about itself; nullopt = unknown.
struct RoboteqTelemetry : MotorTelemetry {
  int32_t fault_flags = 0;       ///< ?FF
  int32_t status_flags = 0;      ///< ?FS
  int32_t motor_flags_left = 0;  ///< ?FM
  int32_t motor_flags_right = 0;
  std::optional<int64_t> faults_read_at;  ///< [us]
  std::optional<int64_t> status_read_at;  ///< [us]

  /// Takes the reply to a query, received at now [us]. False for other replies and malformed ones.
  bool take(const RoboteqReply& reply, const RoboteqLayout& layout, int64_t now);
};

/// Settings of the dialogue with the controller.
struct RoboteqConfig {
  RoboteqLayout layout;
  int64_t watchdog_ms = 250;           ///< of the controller, set and read back [ms]
  ConnectionTimes times;               ///< except for the watchdog
  int64_t query_interval_us = 20'000;  ///< between two queries [us]
  /// After which the next query does not wait for a reply [us]
  int64_t query_patience_us = 50'000;
  int64_t check_interval_us = 1'000'000;  ///< between two checks of the watchdog's setting [us]
};

/// The dialogue after the start-up: commands as given, queries in between: each time the fault
/// flags, and one of the others in turn.
/** After its watchdog has expired the controller resumes its old speed with the next command
 * (Roboteq manual v1.8 p. 286), so the connection gives zero first. */
class RoboteqSession {
 public:
  explicit RoboteqSession(const RoboteqConfig& config);

  /// The controller has acknowledged zero, at now [us].
  void begin(int64_t now);
  /// A reply received at now [us].
  void take(const RoboteqReply& reply, int64_t now);
  /// A command to send now [us].
  void give(const TrackCommand& command, int64_t now);
  /// Holds the controller's own emergency stop (!EX) while true.
  void holdStop(bool hold);
  /// Releases the controller's emergency stop (!MG), repeated for a second while it is reported.
  void releaseStop(int64_t now);
  /// Timeouts and queries; returns all bytes to write now [us].
  std::string poll(int64_t now);

  /// Why the start-up must be repeated; empty = no reason.
  const std::string& problem() const { return problem_; }
  bool stopLatched() const { return (telemetry_.fault_flags & kEmergencyStop) != 0; }
  const RoboteqTelemetry& telemetry() const { return telemetry_; }
  std::map<std::string, int64_t> counters() const;

 private:
  void sendCommand(const std::string& line, int64_t now);
  void ask(const std::string& query, const std::string& key, int64_t now);
  void pollStop(int64_t now);
  void pollQuery(int64_t now);
  void takeAck(int64_t now);
  void takeRefusal(int64_t now);
  void takeValue(const RoboteqReply& reply, int64_t now);
  void checkWatchdog(const RoboteqReply& reply);

  RoboteqConfig config_;
  std::vector<std::string> queries_;
  std::string output_;
  std::string problem_;
  RoboteqTelemetry telemetry_;
  int64_t unreadable_ = 0;

  PendingReplies pending_;
  size_t next_query_ = 0;
  int64_t queried_at_ = 0;
  int64_t checked_at_ = 0;
  int watchdog_mismatches_ = 0;
  int64_t acked_at_ = 0;
  TrackCommand given_;
  bool repeat_ = false;  ///< the last command was refused
  bool hold_stop_ = false;
  bool release_now_ = false;
  int64_t release_until_ = 0;
  int64_t stop_sent_at_ = 0;
};

}  // namespace tread::motor
