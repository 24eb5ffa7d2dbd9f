// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>

namespace tread::ins {

/// Attitude of the device by its own measurement: yaw counter-clockwise from east, nose down
/// positive [rad].
struct Attitude {
  double yaw = 0.0;
  std::optional<double> pitch;
  std::optional<double> roll;
  double yaw_std = 0.0;    ///< NaN if the device does not report it
  double pitch_std = 0.0;  ///< NaN likewise
  double roll_std = 0.0;   ///< NaN likewise
};

/// The last measured attitudes, to bridge the short time to a position measured in between.
class AttitudeMemory {
 public:
  /// An attitude is extrapolated by at most `hold_us`.
  explicit AttitudeMemory(int64_t hold_us) : hold_us_(hold_us) {}

  void add(int64_t utime, const Attitude& attitude);
  /// The newest attitude if it is at most the hold time old, with its yaw extrapolated at its rate.
  /** The whole extrapolated angle is added to the standard deviation of yaw. */
  std::optional<Attitude> at(int64_t utime) const;
  /// Adds pitch and roll of the newest attitude to one with only a heading, within the hold time.
  void complete(int64_t utime, Attitude& attitude) const;
  /// Rate between the last two headings, if both are near `utime`: [rad/s], counter-clockwise
  /// positive.
  std::optional<double> yawRate(int64_t utime) const;
  void clear();

 private:
  int64_t hold_us_;
  std::optional<Attitude> newest_;
  int64_t newest_utime_ = 0;
  std::optional<double> rate_;
};

}  // namespace tread::ins
