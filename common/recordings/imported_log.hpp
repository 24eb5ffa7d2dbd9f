// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "common/drive/drive_log.hpp"
#include "common/geometry/track.hpp"
#include "common/pattern/pattern.hpp"
#include "common/recordings/sessions.hpp"

// Converts the three formats to one recorded drive: times in seconds on one axis, steps that were
// recorded separately divided by a silence without INS, poses at the time of their measurement.

// Which executions a log gets. The recordings hold one command for six seconds and enter it at the
// speed of the one before. From `offset` on (delay and three time constants of the wheels later)
// the motion is nearly steady, and `executions` patterns of `length` follow one after the other:
// each is the same command series entered in its own steady motion. For the k-th command of a log
// (k = 1, 2, ...), its n-th execution has
//     execution id = 10 k + n,   pattern id = the recording's step number,   set version 1,
//     run id 1.
// If a command ends before an execution does, the execution is aborted, with the reason. The same
// holds for a time without a known command, for which no MOTOR is invented.
namespace tread::recordings {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A pose as it was measured; NaN = not measured.
/** The pose lag is removed from its time. */
struct Fix : PoseSample {
  double z = 0.0;          ///< [m]
  double roll = kUnknown;  ///< [rad] in the map
  double pitch = kUnknown;
  double yaw_rate = kUnknown;   ///< [rad/s] of the gyro
  double unix_time = kUnknown;  ///< [s]
  bool new_track = false;       ///< not connected with the fix before
};

/// No channel was measured.
inline Command allUnknown() {
  Command none;
  for (size_t channel = 0; channel < Command::kMaxChannels; ++channel) none[channel] = kUnknown;
  return none;
}

/// One sample of the drive.
struct DriveSample {
  double time = 0.0;               ///< [s]
  Command command;                 ///< by channel, in the units of their kinds
  Command speed;                   ///< [m/s] of the wheels' rims, by channel
  bool automatic = true;           ///< false: idle or driven by the operator
  bool apart = false;              ///< recorded separately from the previous sample
  double voltage = kUnknown;       ///< [V]
  Command current = allUnknown();  ///< [A] by channel
};

/// One command held for a while.
struct CommandRun {
  int step = 0;            ///< number of the command in the recording
  double begin = 0.0;      ///< [s] first sample with it
  double end = 0.0;        ///< [s] one period after the last sample with it
  std::string end_reason;  ///< why it ended
};

/// A gyro reading.
struct GyroReading {
  double time = 0.0;      ///< [s]; the gyro has no lag
  double yaw_rate = 0.0;  ///< [rad/s]
};

/// The ground from a time on.
struct TimedGround {
  double time = 0.0;  ///< [s]
  std::string name;
};

/// What a range finder saw.
struct TimedScan {
  double time = 0.0;  ///< [s] of its first beam
  scan_t message;     ///< without utime and seq
};

struct RecordedDrive {
  CommandChannels channels = trackChannels(CommandKind::kTrackSpeed);  ///< of the commands
  std::vector<Fix> fixes;                                              ///< in order of time
  std::vector<GyroReading> gyro;     ///< in order of time; only where all are kept
  std::vector<DriveSample> drive;    ///< in order of time
  std::vector<CommandRun> runs;      ///< in order of time
  std::vector<TimedScan> scans;      ///< in order of time
  std::vector<TimedGround> grounds;  ///< in order of time, if the recording names them
};

/// Silence between steps that were recorded separately [s].
inline constexpr double kSilence = 2.0;
/// Period of the recordings [s].
inline constexpr double kPeriod = 0.05;
/// Longest gap between poses that is interpolated [s].
inline constexpr double kMaxInterpolated = 0.3;
/// A command is assumed to hold until the next one, at most this long [s].
inline constexpr double kLongestHold = 0.3;
/// Why a command ended where the recording lacks commands.
inline constexpr const char* kCommandsMissing = "commands are missing";

struct ExecutionLayout {
  double offset = 1.2;  ///< [s] from the first sample with a command to its first execution
  double length = 2.0;  ///< [s]
  int executions = 2;   ///< per command, at most 9
};

/// A time without a known command.
struct CommandHole {
  double begin = 0.0;  ///< [s] one period after the last command
  double end = 0.0;    ///< [s]
};

/// Where consecutive samples of one recording are farther apart than a command is assumed to hold.
std::vector<CommandHole> commandHoles(const std::vector<DriveSample>& drive);

/// Contents of a generated log.
struct ImportCounts {
  size_t ins = 0;
  size_t motor = 0;
  size_t scans = 0;
  size_t completed = 0;
  size_t aborted = 0;
  double duration = 0.0;  ///< [s]
  std::vector<CommandHole> holes;
};

/// The events of the log of a recording in order of time: MARK, CONFIG, INS, MOTOR, SCAN,
/// EXECUTION.
/// utime 0 is one second before the recording's time 0.
std::vector<LogEvent> makeLog(const RecordedDrive& recording, const Session& session,
                              const std::string& format, const ExecutionLayout& layout,
                              ImportCounts& counts);

}  // namespace tread::recordings
