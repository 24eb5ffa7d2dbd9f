// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"
#include "common/recordings/sessions.hpp"

// The three formats become one recorded drive: times in seconds on one axis, steps of separate
// recordings apart from each other by a silence in which the INS is gone, poses at the time at
// which they were measured.
namespace tread::recordings {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// A pose as it was measured; NaN = not measured.
struct Fix {
  double time = 0.0;  ///< [s] of the measurement: pose lag removed
  Pose2 T_map_body;
  double z = 0.0;          ///< [m]
  double roll = kUnknown;  ///< [rad] in the map
  double pitch = kUnknown;
  double yaw_rate = kUnknown;   ///< [rad/s] of the gyro
  double unix_time = kUnknown;  ///< [s]
  bool new_track = false;       ///< not connected with the fix before
};

/// One sample of the drive.
struct DriveSample {
  double time = 0.0;                         ///< [s]
  TrackCommand command;                      ///< [m/s]
  TrackCommand speed;                        ///< [m/s] of the wheels' rims
  bool automatic = true;                     ///< false: idle or driven by the operator
  double voltage = kUnknown;                 ///< [V]
  TrackCommand current{kUnknown, kUnknown};  ///< [A]
};

/// One command held for a while.
struct CommandRun {
  int step = 0;            ///< the recording's number of the command
  double begin = 0.0;      ///< [s] first sample with it
  double end = 0.0;        ///< [s] one period after the last sample with it
  std::string end_reason;  ///< why it ended
};

/// What the gyro said at a moment.
struct GyroReading {
  double time = 0.0;      ///< [s]; the gyro is not late
  double yaw_rate = 0.0;  ///< [rad/s]
};

/// Which readings of the gyro are kept.
enum class Gyro {
  kAtFixes,  ///< the one nearest to each fix
  kAll       ///< all of them, beside the fixes
};

struct RecordedDrive {
  std::vector<Fix> fixes;          ///< in order of time
  std::vector<GyroReading> gyro;   ///< in order of time; only where all are kept
  std::vector<DriveSample> drive;  ///< in order of time
  std::vector<CommandRun> runs;    ///< in order of time
};

/// Silence between steps that were recorded apart [s].
inline constexpr double kSilence = 2.0;
/// Period of the recordings [s].
inline constexpr double kPeriod = 0.05;

/// steps/*.csv: poses held and late; a fix where pose_new says so. Throws RecordingError.
/** A session without pose lag leaves the poses at the time at which they were logged. */
RecordedDrive readSteps(const std::string& path, const Session& session,
                        Gyro gyro = Gyro::kAtFixes);
/// aligned/*.csv: lag already removed, poses interpolated to 20 Hz; none inside ICP gaps above 0.3
/// s.
RecordedDrive readAligned(const std::string& path, const Session& session);
/// continuous/*.csv: the whole drive in the map frame, with the operator's part and the battery.
RecordedDrive readContinuous(const std::string& path, const Session& session,
                             Gyro gyro = Gyro::kAtFixes);

}  // namespace tread::recordings
