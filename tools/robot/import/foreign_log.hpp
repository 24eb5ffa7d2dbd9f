// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/robot/import/foreign_drive.hpp"

namespace tread::import {

/// What a log of another robot does not say itself.
struct ForeignRobot {
  std::string pose_channel;   ///< whose poses become INS; empty: the only one that holds poses
  double baseline = 0.0;      ///< [m] between the wheels; 0 = unknown
  double lidar_height = 0.2;  ///< [m] of the range finder above the ground, over the body origin
};

/// Reads an LCM log of a robot with the types of foreign_types.hpp, whatever its channels' names.
/** Poses (odometry or SLAM) become fixes, motor commands drive samples every 50 ms and runs of the
 *  same command, laser scans points. Angles of these lasers count clockwise. Times are the
 *  messages' own; where a message has none, when it was logged. Throws RecordingError with one
 *  line. */
ForeignDrive readForeignLog(const std::string& path, const ForeignRobot& robot);

}  // namespace tread::import
