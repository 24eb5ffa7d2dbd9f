// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include <tread/ins_t.hpp>

#include "common/geometry/se3.hpp"
#include "common/geometry/track.hpp"

namespace tread {

/// The planar pose of a valid INS message; nullopt if position or heading is missing or not finite.
std::optional<Pose2> planarPose(const ins_t& ins);

/// T_map_body of a valid INS message; nullopt as above, or if the height is missing (a device that
/// sends RMC only).
std::optional<Eigen::Isometry3d> spatialPose(const ins_t& ins);

/// Planar body twist; nullopt if the device does not measure it.
std::optional<Twist2> planarTwist(const ins_t& ins);

/// Standard deviation of the horizontal position [m], the larger of both axes; NaN if either is
/// not known.
double horizontalStd(const ins_t& ins);

/// Slope of the ground under the robot, from roll and pitch; unknown without attitude.
Tilt tilt(const ins_t& ins);

/// Sorts INS messages, which may be late, duplicated or out of order, by (utime, seq) before they
/// become a track.
class InsQueue {
 public:
  explicit InsQueue(int64_t span_us) : history_(span_us) {}

  /// `now` [us]: a message whose time is far from it is corrupt.
  void add(const ins_t& ins, int64_t now);
  /// Moves everything up to `horizon` [us] into the track.
  void settle(int64_t horizon);

  /// Time of the first INS message received [us]; INT64_MIN before it.
  int64_t begin() const { return begin_; }
  const TrackHistory& history() const { return history_; }
  int64_t invalid() const { return invalid_; }   ///< its time cannot be
  int64_t tooLate() const { return too_late_; }  ///< arrived after their time had been settled
  int64_t withoutPose() const { return without_pose_; }  ///< no position or no heading

 private:
  void append(const ins_t& ins);

  std::map<std::pair<int64_t, int64_t>, ins_t> waiting_;  ///< by (utime, seq)
  TrackHistory history_;
  int64_t settled_ = INT64_MIN;
  int64_t begin_ = INT64_MIN;
  bool jumped_ = false;
  bool filled_in_ = false;
  int64_t invalid_ = 0;
  int64_t too_late_ = 0;
  int64_t without_pose_ = 0;
};

}  // namespace tread
