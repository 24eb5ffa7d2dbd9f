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

/// Detects ground steeper than plans may use under the robot, and where it lies.
/** The ground counts as too steep if it will be when the robot has stopped, assuming that the slope
 * keeps growing as on the last half metre. A level range finder sees rising ground ahead, but not
 * falling ground: a downward edge is first felt. The ground ahead, in the direction in which the
 * slope grew, then becomes forbidden; the path back is the one on which the robot came. */
class SlopeGuard {
 public:
  /// `max_slope` [rad]; nullopt: no limit.
  explicit SlopeGuard(std::optional<double> max_slope) : max_slope_(max_slope) {}

  /// [s] at its speed until the robot stands, learned from its stops; never less than the initial
  /// value.
  void setStoppingTime(double seconds) { stop_time_ = std::max(kStopTime, seconds); }
  /// Takes the newest pose. Returns ground to keep out of, if it has just become too steep.
  std::optional<Fence> take(const PoseReading& pose);
  /// Whether it stands on ground that is too steep, or nearly so: it may slide there.
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
  double told_ = 0.0;                   ///< [rad] slope last reported; 0 = on good ground
  double slope_ = 0.0;                  ///< [rad] newest
  std::deque<Place> trail_;             ///< recent positions, oldest first
};

}  // namespace tread::planner
