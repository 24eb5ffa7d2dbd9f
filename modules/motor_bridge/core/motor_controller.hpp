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

/// What the controller and the link to it are like; reasons in words, empty = good.
struct DeviceReport {
  std::string link_fault;
  std::string device_fault;
  bool stop_latched = false;                             ///< the controller holds an emergency stop
  StopReason link_code = StopReason::kControllerLost;    ///< of link_fault
  StopReason fault_code = StopReason::kControllerFault;  ///< of device_fault
};

/// A number for each channel of the commands; NaN = unknown.
using ChannelReadings = std::array<double, Command::kMaxChannels>;
inline constexpr ChannelReadings kNoReadings = [] {
  ChannelReadings readings{};
  for (double& reading : readings) reading = std::numeric_limits<double>::quiet_NaN();
  return readings;
}();

/// What a controller last told about itself; NaN = unknown.
struct MotorTelemetry {
  double battery_voltage = std::numeric_limits<double>::quiet_NaN();  ///< [V]
  ChannelReadings current = kNoReadings;   ///< [A] of the channels' motors
  ChannelReadings measured = kNoReadings;  ///< speed [m/s] or steering angle [rad] of the channels
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< of the hottest part [degC]
  int32_t device_flags =
      0;  ///< of MOTOR's device_fault, as the controller's own documents have them
};

/// A motor controller at the end of a byte stream: the door for the next one.
/** Pure: bytes and time [us] are arguments. An implementation starts the controller up after
 * open(), sets and reads back its watchdog, gives commands only to a controller that was started
 * up, repeats zero on a faulty link, and sends an explicit zero before it resumes after silence. */
class MotorController {
 public:
  virtual ~MotorController() = default;

  /// The line was opened: start-up begins.
  virtual void open() = 0;
  /// The line is gone or full.
  virtual void close(const std::string& problem) = 0;
  virtual bool isOpen() const = 0;
  /// Bytes from the controller.
  virtual void receive(std::string_view bytes, int64_t now) = 0;
  /// A command in the unit of the robot's drive; dropped unless the controller is ready.
  virtual void command(const Command& command, int64_t now) = 0;
  /// Holds the controller's own emergency stop as long as true.
  virtual void holdStop(bool hold) = 0;
  virtual void releaseStop(int64_t now) = 0;
  /// Timeouts, queries and start-up; returns all bytes to be written now.
  virtual std::string poll(int64_t now) = 0;
  /// Bytes that make the motors stand, whatever is known of the controller, repeated.
  virtual std::string zeros(int times) const = 0;

  /// Is the controller fit to be given commands?
  virtual DeviceReport report(int64_t now) const = 0;
  virtual bool ready() const = 0;
  /// Unknown unless ready.
  virtual MotorTelemetry telemetry() const = 0;
  /// What is wrong with a line that still works, one line; empty = it is sound.
  virtual std::string lineProblem() const { return ""; }
  /// What cannot be verified with this kind, one line to be told once at the start; empty =
  /// nothing.
  virtual std::string notice() const { return ""; }
  /// What was counted, by its name in words.
  virtual std::map<std::string, int64_t> counters() const = 0;
};

}  // namespace tread::motor
