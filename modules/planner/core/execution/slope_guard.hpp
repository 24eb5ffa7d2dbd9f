// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "common/execution/execution_tracker.hpp"
#include "common/fence/fence.hpp"

namespace tread::planner {

/// Knows when the robot stands on steeper ground than plans may use, and where that lies.
/** It counts as too steep where it will be by the time the robot stands, if the slope goes on to
 * grow as it did on the last half metre. A level range finder sees what rises before it, not what
 * falls: an edge downwards is felt first. What lies ahead, in the direction in which the slope
 * grew, then becomes ground to keep out of; the way back is the one that it came. */
class SlopeGuard {
 public:
  /// `max_slope` [rad]; nothing: no such rule.
  explicit SlopeGuard(std::optional<double> max_slope) : max_slope_(max_slope) {}

  /// [s] at its speed until the robot stands, learned from its stops; never less than at first.
  void setStoppingTime(double seconds) { stop_time_ = std::max(kStopTime, seconds); }
  /// Takes the newest pose. Returns the ground to keep out of from now on, if it has just become
  /// too steep.
  std::optional<Fence> take(const PoseReading& pose);
  /// Whether it stands on ground that is too steep, or nearly: there it may slide.
  bool steep() const;
  /// "tilts 17 deg, plans allow 15"
  std::string words() const;

  static constexpr const char* kName = "steep ground";

 private:
  static constexpr double kStopTime = 0.5;  ///< [s]

  struct Place {
    Eigen::Vector2d p_map;
    double slope;  ///< [rad]
  };

  double expected(const PoseReading& pose) const;
  Fence aheadOf(const Pose2& T_map_body, double slope) const;

  std::optional<double> max_slope_;
  double stop_time_ = kStopTime;        ///< [s]
  int64_t newest_ = INT64_MIN;          ///< [us]
  std::optional<int64_t> steep_since_;  ///< [us]
  double told_ = 0.0;                   ///< [rad] slope that was told last; 0 = on good ground
  double slope_ = 0.0;                  ///< [rad] newest
  std::deque<Place> trail_;             ///< where it has been, oldest first
};

}  // namespace tread::planner
