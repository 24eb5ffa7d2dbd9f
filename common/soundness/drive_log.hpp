// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/drive/drive_log.hpp"
#include "common/soundness/core/drive.hpp"
#include "common/vehicle/model_document.hpp"

// How a log becomes a drive.
//   Commands   from MOTOR. Known while the bridge drives, stands armed, stops, or is disarmed by
//              itself; unknown in faults, emergency stops and under manual control. Where they
//              are unknown, or MOTOR is silent for more than 0.3 s, a segment ends.
//   INS        a pose that repeats the one before while motion is commanded is held, not
//              measured: only its gyro counts. A jump, or more than 1.5 s without a new pose,
//              starts a new segment (its commands begin up to 3 s before).
//   Entry      with encoders at the measured speeds, and after the command of the step before if an
//              imported recording continued at once; else at rest. Where a log without encoders
//              lost MOTOR in the middle of driving, the poses of the next 3 s are dropped.
//   Executions the completed ones of 2 s; longer ones in pieces of 2 s; a segment with few or only
//              shorter ones in pieces of 2 s in which a command was not zero.
namespace tread::gap {

/// Reads a log; its problems are in the drive's notes.
/** Throws std::runtime_error with one clear line if the file cannot be read or is no LCM log. */
Drive readDrive(const std::string& path);

/// The same of a log in memory, without a hash.
Drive toDrive(const DriveLog& log);

/// Throws std::runtime_error with one line if model and log are of different robots: the model's
/// gauge differs by more than 2 % from the track that the recording's commands assume.
void requireSameGauge(const Drive& drive, double gauge);

/// Throws std::runtime_error with one line if two recordings were imported in different ways,
/// because a difference between them could come from the import.
void requireSameImport(const Drive& first, const Drive& second);

/// The same if the recordings name different robots.
void requireSameRobot(const Drive& first, const Drive& second);

/// Reads a log for a model; throws std::runtime_error with one line if it cannot be read or is of
/// another robot: commands of another kind than the model's, or for another gauge.
Drive readDriveFor(const ModelDocument& model, const std::string& path);

/// The same; also throws if the log is unsound or holds no driving.
Drive readSoundDriveFor(const ModelDocument& model, const std::string& path);

}  // namespace tread::gap
