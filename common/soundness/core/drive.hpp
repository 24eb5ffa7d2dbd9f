// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/track.hpp"
#include "common/pattern/pattern.hpp"
#include "common/soundness/core/log_findings.hpp"

namespace tread::gap {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// One reading of the INS. Times are since the log's first message; the pose is all NaN where only
/// the gyro spoke.
struct InsSample : PoseSample {
  double omega = kNotMeasured;  ///< [rad/s] of the gyro
  double roll = kNotMeasured;   ///< [rad] left side up positive
  double pitch = kNotMeasured;  ///< [rad] nose down positive

  bool hasPose() const {
    return std::isfinite(T_map_body.x) && std::isfinite(T_map_body.y) &&
           std::isfinite(T_map_body.yaw);
  }
};

/// Continuous driving: all commands are known, and the INS gives one track.
/** Where the INS jumped or was silent in the middle of driving, the commands begin up to 3 s before
 * the poses do (they are also in the segment before), so that the assumed initial state no longer
 * matters when the poses begin. */
struct Segment {
  std::vector<CommandSample> commands;  ///< in order of time, not empty
  double end = 0.0;                     ///< [s] until when the last command acts
  std::vector<InsSample> ins;           ///< in order of time, within the commands' time
  /// Speeds of tracks or wheels at the beginning, if encoders measure them; otherwise a vehicle at
  /// rest is assumed.
  std::optional<Command> entry_speeds;
  /// The previous command, which acts until the delay is over; zero for a vehicle at rest.
  Command command_before{};

  double begin() const { return commands.front().time; }
};

/// One execution of a pattern (or a piece of driving of the same length).
struct Execution {
  size_t segment = 0;  ///< index of the segment in which it lies
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
};

/// One reading of the battery voltage.
struct VoltageSample {
  double time = 0.0;     ///< [s]
  double voltage = 0.0;  ///< [V]
};

/// Whether a voltage was really measured: the first one is present, and the readings are not all
/// equal.
inline bool isMeasured(const std::vector<VoltageSample>& voltage) {
  return !voltage.empty() && voltage.front().voltage > 0.0 &&
         std::any_of(voltage.begin(), voltage.end(), [&](const VoltageSample& sample) {
           return std::isfinite(sample.voltage) && sample.voltage != voltage.front().voltage;
         });
}

/// Track speeds by encoders: used for the error floor, for entry speeds and as evidence; never
/// fitted. For a car, both are the speed of its drive.
struct EncoderSample {
  double time = 0.0;  ///< [s]
  Command speed{};    ///< [m/s] of each track or wheel
};

/// Motor currents reported by the controller, used as evidence.
/** Either positive forwards, or positive while the motor drives (negative or zero while it brakes):
 * the drive shows which. */
struct CurrentSample {
  double time = 0.0;   ///< [s]
  double left = 0.0;   ///< [A]
  double right = 0.0;  ///< [A]
};

/// What a log records about its import.
struct ImportNote {
  std::string robot;      ///< empty = not recorded
  double baseline = 0.0;  ///< [m] between the tracks, as assumed for the commands; 0 = not recorded
  std::string options;    ///< of the import, in words; empty = not recorded
};

/// Two tracks that drive and turn in the directions of a command, not necessarily by as much: for a
/// car with wheelbase and gauge 1. Zero for a holonomic base, because logs do not describe its
/// wheels.
inline TrackCommand sidesOf(VehicleLayout layout, const Command& command) {
  if (layout == VehicleLayout::kOmni) return {};
  return layout == VehicleLayout::kCar ? rearWheels(command[0], command[1], 1.0, 1.0)
                                       : command.tracks();
}

/// One drive of one vehicle as recorded in a log, ready for the gap workflow.
struct Drive {
  std::string name;    ///< file name of the log
  std::string sha256;  ///< of the file
  CommandKind kind = CommandKind::kPower;
  VehicleLayout layout = VehicleLayout::kTracks;
  std::vector<Segment> segments;        ///< in order of time
  std::vector<Execution> executions;    ///< in order of time; pieces of 2 s if the log names none
  std::vector<VoltageSample> voltage;   ///< empty = not measured
  std::vector<EncoderSample> encoders;  ///< empty = there are none
  std::vector<CurrentSample> currents;  ///< empty = not measured
  std::optional<ImportNote> imported;   ///< nullopt if the robot itself wrote the log
  std::string lost;            ///< part of a damaged file that could not be read; empty = none
  std::vector<LogNote> notes;  ///< notes of the reader and of validateLog()

  TrackCommand sides(const Command& command) const { return sidesOf(layout, command); }

  /// Seconds of driving.
  double driven() const {
    double sum = 0.0;
    for (const Segment& segment : segments) sum += segment.end - segment.begin();
    return sum;
  }
};

}  // namespace tread::gap
