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

/// Whether a number follows another one directly; any bytes may stand in a log.
inline bool isNext(int64_t seq, int64_t before) {
  return static_cast<uint64_t>(seq) - static_cast<uint64_t>(before) == 1;
}

/// A time in which all commands are known.
struct CommandSpan {
  std::vector<CommandSample> commands;  ///< changes only, the first one at the begin; not empty
  double end = 0.0;                     ///< [s]
  VehicleLayout layout = VehicleLayout::kTracks;
  bool after_silence = false;  ///< MOTOR messages before it are missing

  double begin() const { return commands.front().time; }
};

/// What the machine obeys at a MOTOR message; nothing where that is unknown.
std::optional<Command> obeyed(const motor_t& motor);

/// The spans of a log, at least a second long, in order of time.
std::vector<CommandSpan> knownCommands(const SortedLog& log);

/// The command that acts at a time [s] within a span (the first one before it).
Command commandAt(const CommandSpan& span, double time);

/// Whether the span commands zero from `from` to `to` [s].
bool standsBetween(const CommandSpan& span, double from, double to);

/// Track speeds as the encoders say, where they do.
std::vector<EncoderSample> encoderSamples(const SortedLog& log);

/// Motor currents, where both are measured.
std::vector<CurrentSample> currentSamples(const SortedLog& log);

/// Voltages of the battery, where they are measured.
std::vector<VoltageSample> voltageSamples(const SortedLog& log);

/// An INS message within a span of known commands.
struct InsReading {
  InsSample sample;        ///< yaw as the message says; pose NaN where there is none or it is held
  bool fresh = false;      ///< whether the sample has a pose
  bool new_track = false;  ///< the first pose after a jump
};

/// A time in which the INS repeated its pose although the vehicle was told to move.
struct HeldPose {
  double begin = 0.0;  ///< [s]
  double end = 0.0;    ///< [s]
};

/// What the INS said in a span.
struct SpanReadings {
  std::vector<InsReading> readings;  ///< in order of time
  std::vector<HeldPose> held;        ///< in order of time
  size_t poses = 0;                  ///< messages with a pose, held ones too, while it drove
  size_t repeated = 0;               ///< of these: held
};

/// The INS messages in a span. Equal poses are real where nothing is commanded for a second, and
/// held elsewhere.
SpanReadings insReadings(const SortedLog& log, const CommandSpan& span);

/// A span with what the INS said in it.
struct HeardSpan {
  CommandSpan commands;
  SpanReadings ins;
};

/// Length of an execution [s].
inline constexpr double kExecutionLength = 2.0;

/// The segments of a log: spans, cut where the INS begins a new track.
std::vector<Segment> segmentsOf(const std::vector<HeardSpan>& spans,
                                const std::vector<EncoderSample>& encoders);

/// The executions to be predicted; `records` in seconds, in order of time.
std::vector<Execution> executionsOf(VehicleLayout layout, const std::vector<Segment>& segments,
                                    const std::vector<Execution>& records);

inline constexpr int64_t kOvertaking = 200'000;  ///< [us] by which messages may come out of order

/// Missing channels, commands of two kinds, silences, jumps and frozen
/// poses.
void checkChannels(const SortedLog& log, const std::vector<HeardSpan>& spans, Diagnostics& notes);

/// Who gave the messages of a log their numbers.
enum class Numbering {
  kByRobot,   ///< a message that the recorder lost is missing in them
  kByImport,  ///< they count what the recording has
};

/// Clocks that jump or go back, pauses over which the robot did not move among them.
void checkClocks(const SortedLog& log, Numbering numbering, Diagnostics& notes);

/// Commands and poses whose clocks differ, by how much.
void checkOffset(const SortedLog& log, const std::vector<HeardSpan>& spans, Diagnostics& notes);

/// Two robots (or two publishers of a channel) in one log.
void checkPublishers(const SortedLog& log, Diagnostics& notes);

}  // namespace tread::gap
