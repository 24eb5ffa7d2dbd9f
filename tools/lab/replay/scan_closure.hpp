// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include "modules/scan_matching/core/scan_matcher.hpp"

namespace tread {

/// A sweep and its pose from scan matching.
struct MatchedSweep {
  scan_matching::Sweep sweep;
  scan_matching::MatchedPose pose;
};

/// Checks scans for mutual consistency, without another reference.
/** Each pair of three consecutive scans is matched separately: first to second to third must agree
 * with first to third. The pairs share scans, so their errors are not quite independent, as is
 * assumed. */
struct ScanClosure {
  std::vector<double> position;  ///< [m] closing errors of the triangles
  std::vector<double> yaw;       ///< [rad]
  double normalized_position =
      /// root mean square per axis relative to the published standard deviation; 1 = consistent
      0.0;
  double normalized_yaw = 0.0;  ///< the same
  double within_two = 0.0;      ///< share of all axes within two published standard deviations
  int64_t undetermined = 0;     ///< triangles with a side that does not determine some direction
};

/// Triangles of consecutive scans with known, connected poses.
ScanClosure closureOf(const std::vector<MatchedSweep>& sweeps,
                      const scan_matching::ScanMatcherConfig& config);

}  // namespace tread
