// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/robot/import/foreign_drive.hpp"

namespace tread::import {

/// Facts that another robot's log does not contain.
struct ForeignRobot {
  std::string pose_channel;  ///< channel of the poses; empty: the only one with poses
  double baseline = 0.0;     ///< [m] between the wheels; 0 = unknown
  /// [m] of the range finder above the ground; it is assumed over the body origin
  double lidar_height = 0.2;
};

/// Reads another robot's LCM log with the types of foreign_types.hpp; channel names do not matter.
/** Poses (odometry or SLAM) become fixes, motor commands drive samples every 50 ms and runs of the
 *  same command, laser scans points. Angles of these lasers count clockwise. A message
 *  without a time stamp gets its time of logging. Throws RecordingError with one
 *  line. */
ForeignDrive readForeignLog(const std::string& path, const ForeignRobot& robot);

}  // namespace tread::import
