// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include <Eigen/Geometry>

namespace tread::mapping {

/// The recent poses of the body in space, interpolated between, never extrapolated.
class SpatialTrack {
 public:
  enum class PoseCheck {
    kTaken,
    kNotNewer,  ///< not newer than the last pose, or a negative time: refused
    kDoubted,   ///< farther from the last pose than the robot can move: set aside for now
    kJump       ///< the doubted poses agree with each other: the track restarts
  };

  /// Keeps poses that are at most `span_us` older than the newest. A step is doubted if it exceeds
  /// what `top_speed` [m/s] allows by more than half a metre; three consistent ones in a row are a
  /// jump, while a single one is forgotten as soon as the track continues.
  SpatialTrack(int64_t span_us, double top_speed) : span_us_(span_us), top_speed_(top_speed) {}

  PoseCheck push(int64_t utime, const Eigen::Isometry3d& T_map_body);
  void clear();

  /// Pose at a time between two kept poses at most `max_gap_us` apart; else nullopt.
  std::optional<Eigen::Isometry3d> at(int64_t utime, int64_t max_gap_us) const;

  bool empty() const { return poses_.empty(); }
  /// [us] of the newest pose; 0 if there is none.
  int64_t newest() const { return poses_.empty() ? 0 : poses_.back().utime; }

 private:
  struct SpatialPose {
    int64_t utime;
    Eigen::Isometry3d T_map_body;
  };

  bool follows(const SpatialPose& next, const SpatialPose& before) const;
  PoseCheck doubt(const SpatialPose& pose);
  void append(const SpatialPose& pose);

  int64_t span_us_;
  double top_speed_;
  std::deque<SpatialPose> poses_;
  std::deque<SpatialPose> doubted_;
};

}  // namespace tread::mapping
