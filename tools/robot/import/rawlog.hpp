// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/robot/import/foreign_drive.hpp"

namespace tread::import {

/// Reads an MRPT rawlog: odometry becomes poses, planar range scans and Velodyne's become scans.
/** Time 0 is that of the first record. A damaged file gives what stands before the damage, and says
 *  so among what was left out. Throws RecordingError with one line if there is nothing to take. */
ForeignDrive readRawlog(const std::string& path);

}  // namespace tread::import
