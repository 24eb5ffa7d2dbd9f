// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include <tread/scan_t.hpp>

#include "modules/mapping/core/local_map.hpp"

namespace tread::mapping {

/// A good scan that waits for the poses of its beams.
struct WaitingScan {
  int64_t first = 0;  ///< [us] time of the first beam
  int64_t last = 0;   ///< [us] time of the last
  Eigen::Isometry3d T_body_sensor;
  std::vector<Beam> beams;
};

/// Checks a SCAN message field by field and takes its beams; else nothing and the reason.
/** NaN and ranges below range_min are no measurement; +inf and ranges above range_max saw nothing
 *  up to range_max. */
std::optional<WaitingScan> readScan(const scan_t& message, std::string& refusal);

}  // namespace tread::mapping
