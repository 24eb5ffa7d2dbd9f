// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include <Eigen/Core>

#include "modules/ins_driver/core/ins_estimate.hpp"

namespace tread::ins {

/// Tells gaps and jumps in a track: what the vehicle cannot have done, the measurement did.
class TrackMonitor {
 public:
  explicit TrackMonitor(const InsConfig& config)
      : period_us_(config.period_us), max_speed_(config.max_speed), slack_(config.jump_slack) {}

  /// True if this message comes more than three periods after the one before.
  /** The period is the configured one, or the median of the last nine intervals once there are
   * three. */
  bool isGap(int64_t utime);
  /// True if the body cannot have come here from the position before. The new position is the next
  /// one's reference.
  bool isJump(int64_t utime, const Eigen::Vector3d& p_map_body);

 private:
  int64_t typicalPeriod() const;

  int64_t period_us_;
  double max_speed_;
  double slack_;
  std::deque<int64_t> intervals_;
  std::optional<int64_t> last_utime_;
  std::optional<int64_t> position_utime_;
  Eigen::Vector2d position_ = Eigen::Vector2d::Zero();
};

}  // namespace tread::ins
