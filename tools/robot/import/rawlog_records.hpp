// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>

#include <tread/scan_t.hpp>

#include "common/geometry/se2.hpp"

namespace tread::import {

/// The pose of the odometry.
struct OdometryPose {
  double time = 0.0;  ///< [s] since 1970
  Pose2 T_odom_body;
};

/// One sweep of a range finder, or a slice of points.
struct RawlogScan {
  double time = 0.0;  ///< [s] since 1970
  scan_t message;     ///< without utime and seq
};

/// What is not taken, and why.
struct LeftOut {
  std::string what;
  bool lost = false;  ///< it is a part of the drive, but unusable
};

/// The reader cannot go on.
struct RawlogProblem {
  std::string what;
};

using RawlogRecord = std::variant<OdometryPose, RawlogScan, LeftOut, RawlogProblem>;

/// Reads the objects of an MRPT rawlog in a process of its own and hands over what they hold.
/** MRPT's reader checks neither lengths nor counts: on a damaged file it writes out of bounds, asks
 * for all memory or hangs. That process may die; then the last record says so.
 * Throws RecordingError if the file cannot be opened or no process be started. */
void readRawlogRecords(const std::string& path, const std::function<void(RawlogRecord)>& take);

}  // namespace tread::import
