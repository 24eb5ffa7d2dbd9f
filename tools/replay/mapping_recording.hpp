// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <tread/ins_t.hpp>
#include <tread/scan_t.hpp>

#include "modules/mapping/mapping_config.hpp"

namespace tread {

/// A recording of range scans with poses, as Tread's messages.
struct MappingRecording {
  std::string name;
  std::vector<ins_t> poses;       ///< in order of time
  std::vector<scan_t> scans;      ///< in order of time
  int64_t skipped = 0;            ///< lines or messages of the recording that were not whole
  std::string problem;            ///< one clear line if the file is damaged; what is whole was read
  mapping::MappingConfig config;  ///< that fits its robot and its surroundings
};

/// Reads a recording by its name: *.gz and *.clf as CARMEN text with corrected poses (FLASER
/// lines), others as the LCM log of an MBot (2017).
/** Throws std::runtime_error with one clear line if it cannot be read or holds no scan. */
MappingRecording readMappingRecording(const std::string& path);

}  // namespace tread
