// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <tread/ins_t.hpp>
#include <tread/scan_t.hpp>

#include "modules/mapping/mapping_config.hpp"

namespace tread {

/// A recording of range scans with poses, as the messages of this house.
struct MappingRecording {
  std::string name;
  std::vector<ins_t> poses;       ///< in order of time
  std::vector<scan_t> scans;      ///< in order of time
  int64_t skipped = 0;            ///< lines or messages of the recording that were not whole
  std::string problem;            ///< one clear line if the file is damaged; what is whole was read
  mapping::MappingConfig config;  ///< that fits its robot and its surroundings
};

/// Reads a CARMEN text log with corrected poses (FLASER lines), plain or gzipped.
/** Such logs have a pose about every metre and no times. Times are made up as if the robot had
 *  driven at 1 m/s and turned at no more than 0.5 rad/s between the poses, along arcs. Throws
 *  std::runtime_error with one clear line if it cannot be read or holds no scan. */
MappingRecording readCarmenLog(const std::string& path);

/// Reads an LCM log of an MBot (2017): LIDAR and TRUE_POSE of foreign types.
/** Its beams run clockwise and unevenly, so each sweep becomes a slice of points. A sweep is taken
 * to end when it was logged: that fits the poses, which are stamped on arrival too, better than the
 *  stamps of LIDAR. Throws std::runtime_error with one clear line if it cannot be read or holds no
 *  scan. */
MappingRecording readMbotLog(const std::string& path);

}  // namespace tread
