// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <tread/scan_t.hpp>

#include "common/geometry/beam.hpp"

namespace tread {

/// A valid scan, as beams.
struct ReceivedScan {
  int64_t first = 0;  ///< [us] time of the first beam
  int64_t last = 0;   ///< [us] time of the last
  Eigen::Isometry3d T_body_sensor;
  std::vector<Beam> beams;
  uint64_t fingerprint = 0;  ///< of all measured values, bit for bit
};

/// Checks a SCAN message field by field and converts it to beams; nullopt and the reason if it is
/// invalid.
/** NaN and ranges below range_min are no measurement; for +inf and ranges above range_max the beam
 * is free up to range_max. */
std::optional<ReceivedScan> readScan(const scan_t& message, std::string& refusal);

}  // namespace tread
