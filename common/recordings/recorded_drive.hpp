// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/recordings/imported_log.hpp"

namespace tread::recordings {

/// Which readings of the gyro are kept.
enum class Gyro {
  kAtFixes,  ///< the one nearest to each fix
  kAll       ///< all of them, beside the fixes
};

/// steps/*.csv: poses are held and late; a new fix where pose_new is set. Throws RecordingError.
/** For a session without pose lag the poses keep the time at which they were logged. */
RecordedDrive readSteps(const std::string& path, const Session& session,
                        Gyro gyro = Gyro::kAtFixes);
/// aligned/*.csv: lag already removed, poses interpolated to 20 Hz; none inside ICP gaps above 0.3
/// s.
RecordedDrive readAligned(const std::string& path, const Session& session);
/// continuous/*.csv: the whole drive in the map frame, with the operator's part and the battery.
RecordedDrive readContinuous(const std::string& path, const Session& session,
                             Gyro gyro = Gyro::kAtFixes);

}  // namespace tread::recordings
