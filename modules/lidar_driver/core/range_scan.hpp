// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tread::lidar {

/// One sweep of a 2D range finder in the sensor frame.
struct RangeScan {
  int64_t utime = 0;          ///< [us] of the first beam
  int64_t duration_us = 0;    ///< [us] from the first to the last beam
  double angle_first = 0.0;   ///< [rad] 0 = forward, counter-clockwise positive
  double angle_step = 0.0;    ///< [rad] from beam to beam
  double range_min = 0.0;     ///< [m] shorter is not a measurement
  double range_max = 0.0;     ///< [m] longer means that nothing was hit
  std::vector<float> ranges;  ///< [m]
};

/// Angles of a SCIP 2.0 device from its own parameters: AMIN, AMAX, AFRT, ARES.
/** Not from the library's aperture, which is one step too wide (n instead of n-1 steps) and ignores
 * AFRT. */
struct ScipGeometry {
  int first_step = 0;      ///< AMIN
  int last_step = 0;       ///< AMAX
  int front_step = 0;      ///< AFRT: the step that looks forward
  int steps_per_turn = 0;  ///< ARES

  double angleFirst() const;
  double angleStep() const;
  /// Share of a turn between the first and the last beam.
  double shareOfTurn() const;
  /// One clear line if these numbers cannot be a device's; nothing if they can.
  std::optional<std::string> problem() const;
};

/// What the check lets through.
struct ScanLimits {
  double range_min = 0.1;   ///< [m]
  double range_max = 30.0;  ///< [m]
  int max_beams = 4000;
  int beam_stride = 1;  ///< every n-th beam is kept
};

/// Checks scans before they reach the bus. Time never goes back; a beam is a range, +inf (nothing
/// hit) or NaN.
class ScanCheck {
 public:
  explicit ScanCheck(const ScanLimits& limits) : limits_(limits) {}

  /// The scan as it is to be published, or nothing and the reason in refusal().
  std::optional<RangeScan> accept(const RangeScan& raw);
  const std::string& refusal() const { return refusal_; }

 private:
  std::string problemOf(const RangeScan& raw) const;

  ScanLimits limits_;
  int64_t last_utime_ = INT64_MIN;
  std::string refusal_;
};

}  // namespace tread::lidar
