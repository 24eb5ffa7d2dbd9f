// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include "common/execution/stop_reason.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::motor {

/// State of the controller and its link; reasons in words, empty = good.
struct DeviceReport {
  std::string link_fault;
  std::string device_fault;
  bool stop_latched = false;                             ///< the controller holds an emergency stop
  StopReason link_code = StopReason::kControllerLost;    ///< of link_fault
  StopReason fault_code = StopReason::kControllerFault;  ///< of device_fault
};

/// A number for each command channel; NaN = unknown.
using ChannelReadings = std::array<double, Command::kMaxChannels>;
inline constexpr ChannelReadings kNoReadings = [] {
  ChannelReadings readings{};
  for (double& reading : readings) reading = std::numeric_limits<double>::quiet_NaN();
  return readings;
}();

/// A controller's latest data about itself; NaN = unknown.
struct MotorTelemetry {
  double battery_voltage = std::numeric_limits<double>::quiet_NaN();  ///< [V]
  ChannelReadings current = kNoReadings;   ///< [A] of the channels' motors
  ChannelReadings measured = kNoReadings;  ///< speed [m/s] or steering angle [rad] of the channels
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< of the hottest part [degC]
  int32_t device_flags = 0;  ///< for MOTOR's device_fault, as in the controller's documentation
};

/// A motor controller at the end of a byte stream: the interface for further kinds.
/** Pure: bytes and time [us] are arguments. An implementation starts the controller up after
 * open(), sets its watchdog and reads it back, gives commands only after the start-up, repeats
 * zero on a faulty link, and sends an explicit zero before it resumes after silence. */
class MotorController {
 public:
  virtual ~MotorController() = default;

  /// The line was opened: the start-up begins.
  virtual void open() = 0;
  /// The line was closed or is full.
  virtual void close(const std::string& problem) = 0;
  virtual bool isOpen() const = 0;
  /// Bytes from the controller.
  virtual void receive(std::string_view bytes, int64_t now) = 0;
  /// A command in the unit of the robot's drive; ignored unless the controller is ready.
  virtual void command(const Command& command, int64_t now) = 0;
  /// Holds the controller's own emergency stop while true.
  virtual void holdStop(bool hold) = 0;
  virtual void releaseStop(int64_t now) = 0;
  /// Timeouts, queries and start-up; returns all bytes to write now.
  virtual std::string poll(int64_t now) = 0;
  /// Bytes that stop the motors in any state of the controller, repeated.
  virtual std::string zeros(int times) const = 0;

  /// Whether the controller can be given commands.
  virtual DeviceReport report(int64_t now) const = 0;
  virtual bool ready() const = 0;
  /// Unknown unless ready.
  virtual MotorTelemetry telemetry() const = 0;
  /// What is wrong with a line that still works, one line; empty = nothing.
  virtual std::string lineProblem() const { return ""; }
  /// What cannot be verified with this kind, one line to report once at the start; empty = nothing.
  virtual std::string notice() const { return ""; }
  /// Counters by name, in words.
  virtual std::map<std::string, int64_t> counters() const = 0;
};

}  // namespace tread::motor
