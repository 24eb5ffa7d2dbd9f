// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace tread::lidar {

/// Of a slice: capacity of one message of at most 60 kB.
inline constexpr size_t kMostPoints = 4900;

/// One sweep of a 2D range finder, or one slice of a 3D one, in the sensor frame.
struct RangeScan {
  int64_t utime = 0;          ///< [us] of the first beam
  int64_t duration_us = 0;    ///< [us] from the first to the last beam
  double angle_first = 0.0;   ///< [rad] 0 = forward, counter-clockwise positive
  double angle_step = 0.0;    ///< [rad] from beam to beam
  double range_min = 0.0;     ///< [m] shorter ranges are no measurement
  double range_max = 0.0;     ///< [m] longer ranges mean no hit
  std::vector<float> ranges;  ///< [m]; none in a slice
  /// Of a slice [m]: forward, left, up, at equal time steps; NaN without a return.
  std::vector<std::array<float, 3>> points;
};

/// Limits of the check.
struct ScanLimits {
  double range_min = 0.1;   ///< [m]
  double range_max = 30.0;  ///< [m]
  int max_beams = 4000;
  int beam_stride = 1;  ///< every n-th beam is kept; not for slices
};

/// Checks scans before they are published. Time never goes back; a beam is a range, +inf (no hit)
/// or NaN, a point is within the limits or NaN.
class ScanCheck {
 public:
  explicit ScanCheck(const ScanLimits& limits) : limits_(limits) {}

  /// The scan to publish; nullopt and the reason in refusal() if it is refused.
  std::optional<RangeScan> accept(const RangeScan& raw);
  const std::string& refusal() const { return refusal_; }

 private:
  std::string problemOf(const RangeScan& raw) const;
  std::string problemOfBeams(const RangeScan& raw) const;
  void thin(RangeScan& scan) const;

  ScanLimits limits_;
  int64_t last_utime_ = INT64_MIN;
  std::string refusal_;
};

}  // namespace tread::lidar
