// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/motor_bridge/core/controller_connection.hpp"
#include "modules/motor_bridge/line_protocol/line_template.hpp"

namespace tread::motor {

/// Checksum after each line.
enum class LineChecksum { kNone, kXor, kSum8, kCrc8, kCrc16 };

/// A request and the required reply.
struct LineExchange {
  LineTemplate send;
  LineTemplate expect;
};

/// A bit of the number `faults` in replies.
struct LineFault {
  int32_t mask = 0;
  std::string means;     ///< for people
  bool latched = false;  ///< it indicates the controller's own emergency stop
  bool voltage = false;  ///< it concerns the battery's voltage
};

/// A controller's line protocol, as described in YAML.
struct LineDescription {
  std::string name;
  std::string end = "\r";  ///< of each line we write; the end of lines we read is CR or LF
  LineChecksum checksum = LineChecksum::kNone;
  std::string checksum_mark;  ///< text between a line and its checksum, which is in hexadecimal
  size_t checksum_skip = 0;   ///< number of leading characters that are not covered
  /// Lines with {left} and {right}, {throttle} and {steering}, or {wheel1}, ...
  std::vector<LineTemplate> command;
  std::vector<LineTemplate> stop;    ///< lines for zero; empty: the command with zeros
  std::string acknowledge;           ///< reply to each of these lines; empty = none
  std::vector<LineTemplate> errors;  ///< replies that refuse
  std::string restarted;             ///< a line that only a restarted controller sends
  std::vector<LineExchange> start;
  std::vector<LineExchange> queries;
  std::string emergency_stop;  ///< line that latches the controller's own stop; empty = none
  std::string release_stop;
  std::vector<LineFault> faults;
  double full_command = 1000.0;   ///< {left} and {right}, {throttle}, or {wheel1}, at full command
  double full_steering = 1000.0;  ///< {steering} at the largest angle to the left, above the centre
  double steering_centre = 0.0;   ///< {steering} straight ahead, as the 1500 us of a servo
  double watchdog_unit = 0.001;   ///< [s] per count of {watchdog}
  double battery_voltage = 1.0;   ///< [V] per count
  double current = 1.0;           ///< [A] per count
  double speed = 1.0;             ///< [m/s] of track per count
  double temperature = 1.0;       ///< [degC] per count
  int64_t query_interval_us = 20'000;
  ConnectionTimes times;
  // Of the robot.
  double full_scale = 1.0;          ///< full command, in the unit of the drive
  double max_steering = 0.0;        ///< [rad] of a car; 0 = tracks
  std::vector<bool> invert_wheels;  ///< of each wheel of a holonomic base; empty = another vehicle
  bool swapped = false;             ///< the right track is connected to the controller's {left}
  bool invert_left = false;
  bool invert_right = false;

  /// Names of the wheels of a holonomic base: wheel1, wheel2, ...
  std::vector<std::string> wheels() const;
  /// Whether a reply of the start-up or of a query reads the watchdog back.
  bool readsWatchdog() const;
  /// {watchdog} in the controller's counts.
  double watchdogCounts() const;
  /// A line with its checksum and end.
  std::string framed(const std::string& line) const;
  /// The line without its checksum; false if that is wrong or missing.
  bool unframe(std::string& line) const;
};

/// Reads a description; throws ConfigError with file:line. tests/data/controllers has two examples.
/** Names of numbers: {left}, {right} in `command` (counts; full_command is full ahead), of a car
 * {throttle} and {steering} (full_steering and steering_centre: counts), of a holonomic base
 * {wheel1}, {wheel2}, ... in the order of robot.yaml; {watchdog} in `start` and `queries`; in
 * replies also battery_voltage, current_left, current_right, speed_left, speed_right (or
 * current_wheel1, ..., speed_wheel1, ...), temperature, faults. {left} is channel 1 of robot.yaml.
 */
LineDescription readLineDescription(ConfigReader& reader, const DriveDescription& drive);

}  // namespace tread::motor
