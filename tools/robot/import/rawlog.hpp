// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/robot/import/foreign_drive.hpp"

namespace tread::import {

/// Reads an MRPT rawlog: odometry becomes poses, planar range scans and Velodyne's become scans.
/** Time 0 is that of the first record. Of a damaged file the part before the damage is read, and
 * the rest reported as left out. Throws RecordingError with one line if no record is usable. */
ForeignDrive readRawlog(const std::string& path);

}  // namespace tread::import
