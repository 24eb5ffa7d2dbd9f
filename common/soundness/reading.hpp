// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <vector>

#include "common/drive/drive_log.hpp"
#include "common/soundness/core/drive.hpp"
#include "common/soundness/core/log_validation.hpp"

namespace tread::gap {

/// Commands and measurements of a log in order of their own time.
struct SortedLog {
  explicit SortedLog(const DriveLog& drive_log);

  const DriveLog& drive;
  std::vector<motor_t> motor;
  std::vector<ins_t> ins;
  VehicleLayout layout = VehicleLayout::kTracks;
  size_t channels = 2;  ///< of its commands
  int64_t origin = 0;   ///< [us] utime of the first INS or MOTOR; time 0 of the drive

  /// Seconds since time 0.
  double seconds(int64_t utime) const { return 1e-6 * static_cast<double>(utime - origin); }
};

/// Whether one sequence number directly follows another; a log may hold any bytes.
inline bool isNext(int64_t seq, int64_t before) {
  return static_cast<uint64_t>(seq) - static_cast<uint64_t>(before) == 1;
}

/// A time in which all commands are known.
struct CommandSpan {
  /// Changes only, starting with the one at the begin; not empty
  std::vector<CommandSample> commands;
  double end = 0.0;  ///< [s]
  VehicleLayout layout = VehicleLayout::kTracks;
  bool after_silence = false;  ///< MOTOR messages are missing before it

  double begin() const { return commands.front().time; }
};

/// The command that acts after a MOTOR message; nullopt if it is unknown.
std::optional<Command> obeyed(const motor_t& motor);

/// The spans of a log, at least a second long, in order of time.
std::vector<CommandSpan> knownCommands(const SortedLog& log);

/// The command that acts at a time [s] within a span (before it, the first one).
Command commandAt(const CommandSpan& span, double time);

/// Whether the span commands zero from `from` to `to` [s].
bool standsBetween(const CommandSpan& span, double from, double to);

/// Track speeds by encoders, if available.
std::vector<EncoderSample> encoderSamples(const SortedLog& log);

/// Motor currents, if both are measured.
std::vector<CurrentSample> currentSamples(const SortedLog& log);

/// Battery voltages, if measured.
std::vector<VoltageSample> voltageSamples(const SortedLog& log);

/// An INS message within a span of known commands.
struct InsReading {
  InsSample sample;        ///< yaw as sent; pose NaN where there is none or it is held
  bool fresh = false;      ///< whether the sample has a pose
  bool new_track = false;  ///< the first pose after a jump
};

/// A time in which the INS repeated its pose although motion was commanded.
struct HeldPose {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
};

/// INS readings of a span.
struct SpanReadings {
  std::vector<InsReading> readings;  ///< in order of time
  std::vector<HeldPose> held;        ///< in order of time
  size_t poses = 0;                  ///< messages with a pose, held ones included, while driving
  size_t repeated = 0;               ///< of these: held
};

/// The INS messages in a span. Equal poses are real after a second of zero command; otherwise they
/// are held.
SpanReadings insReadings(const SortedLog& log, const CommandSpan& span);

/// A span with its INS readings.
struct HeardSpan {
  CommandSpan commands;
  SpanReadings ins;
};

inline constexpr double kInsSilence = 1.5;  ///< [s] without a new pose, which ends a track

/// Length of an execution [s].
inline constexpr double kExecutionLength = 2.0;

inline constexpr int64_t kOvertaking = 200'000;  ///< [us] by which messages may arrive out of order

}  // namespace tread::gap
