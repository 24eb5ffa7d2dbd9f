// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include "modules/scan_matching/core/scan_matcher.hpp"

namespace tread {

/// A sweep and the pose that scan matching gave it.
struct MatchedSweep {
  scan_matching::Sweep sweep;
  scan_matching::MatchedPose pose;
};

/// Whether what scans tell of each other fits together; no other reference has a part in it.
/** Of three scans in a row each is laid onto each other one alone: from the first to the second and
 * on to the third must lead where the first to the third leads. The three share scans, so that
 * their errors are not quite independent, as is assumed. */
struct ScanClosure {
  std::vector<double> position;  ///< [m] by which triangles do not close
  std::vector<double> yaw;       ///< [rad]
  double normalized_position =
      0.0;                      ///< root mean square per axis over the told deviation; 1 = honest
  double normalized_yaw = 0.0;  ///< the same
  double within_two = 0.0;      ///< share of all axes within two told standard deviations
  int64_t undetermined = 0;     ///< triangles of which a side tells nothing about some direction
};

/// Triangles of scans in a row whose poses are known and connected.
ScanClosure closureOf(const std::vector<MatchedSweep>& sweeps,
                      const scan_matching::ScanMatcherConfig& config);

}  // namespace tread
