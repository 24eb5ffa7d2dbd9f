// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <tread/ins_t.hpp>
#include <tread/scan_t.hpp>

#include "common/geometry/track.hpp"
#include "common/grid/grid.hpp"
#include "modules/ins_driver/core/ins_pipeline.hpp"
#include "modules/ins_driver/ins_driver_node.hpp"
#include "modules/mapping/mapping_node.hpp"

namespace tread {

/// A recording of range scans with poses, as Tread's messages.
struct MappingRecording {
  std::string name;
  std::vector<ins_t> poses;   ///< ordered by time
  std::vector<scan_t> scans;  ///< ordered by time
  /// [us] times of the scans' last beams by the range finder's clock, if it is steadier than their
  /// utime; else empty.
  std::vector<int64_t> device_times;
  int64_t skipped = 0;  ///< incomplete lines or messages of the recording
  std::string problem;  ///< one clear line if the file is damaged; the undamaged part was read
  mapping::MappingConfig config;  ///< for its robot and environment
};

}  // namespace tread
