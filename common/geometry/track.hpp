// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>

#include "common/geometry/se2.hpp"

namespace tread {

/// A pose with the time at which it was measured.
struct TimedPose {
  int64_t utime = 0;  ///< [us]
  Pose2 T_map_body;   ///< yaw unwrapped along the track
};

/// The same for the analysis of drives: in seconds; the user of it documents time 0.
struct PoseSample {
  double time = 0.0;  ///< [s]
  Pose2 T_map_body;   ///< yaw unwrapped along the track
};

/// The recent track of a body: timed poses in order, yaw made continuous, interpolated between
/// poses, never extrapolated.
/** Replaces CPose2DInterpolator, which turns the short way round and accepts any gap. */
class PoseTrack {
 public:
  /// Keeps poses that are at most `span_us` older than the newest.
  explicit PoseTrack(int64_t span_us) : span_us_(span_us) {}

  /// Appends a pose; yaw may be wrapped and is unwrapped to the turn nearest to its predecessor.
  /** Returns false (and keeps the track) if it is not newer than the last pose, its time negative
   * or the pose not finite. */
  bool push(int64_t utime, const Pose2& T_map_body);

  /// Pose at a time between two kept poses at most `max_gap_us` apart (SE(2) interpolation); else
  /// nullopt.
  std::optional<Pose2> at(int64_t utime, int64_t max_gap_us) const;

  /// Longest time between neighbouring kept poses that cover [from, to]; nullopt if they do not
  /// cover it.
  std::optional<int64_t> longestGap(int64_t from, int64_t to) const;

  /// Mean body twist over [utime - window, utime] from the interpolated end poses; nullopt where
  /// at() gives none.
  std::optional<Twist2> twistBefore(int64_t utime, int64_t window_us, int64_t max_gap_us) const;

  const std::deque<TimedPose>& poses() const { return poses_; }
  void clear() { poses_.clear(); }

 private:
  int64_t span_us_;
  std::deque<TimedPose> poses_;
};

/// Slope of the ground under the robot; NaN = unknown.
struct Tilt {
  static constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  double inclination = kUnknown;  ///< [rad] against level ground
  double ahead = kUnknown;        ///< [1] rise per metre along body x
  double left = kUnknown;         ///< [1] rise per metre along body y
};

/// Recent INS poses as tracks, split where the INS jumped, and the tilt along them.
class TrackHistory {
 public:
  /// Keeps what is at most `span_us` older than the newest pose.
  explicit TrackHistory(int64_t span_us) : span_us_(span_us) {}

  /// Appends a pose; `new_track`: not connected with what came before.
  /** Returns false if it is not newer than the last pose or not finite. */
  bool push(int64_t utime, const Pose2& T_map_body, const Tilt& tilt, bool new_track);

  /// The track that was being driven at a time, or nullptr.
  const PoseTrack* covering(int64_t utime) const;

  /// Mean tilt at the poses in [from, to]; NaN if it is unknown there.
  Tilt meanTilt(int64_t from, int64_t to) const;

  /// Time of the newest pose [us]; INT64_MIN before the first.
  int64_t newest() const { return newest_; }

 private:
  struct TimedTilt {
    int64_t utime;
    Tilt tilt;
  };

  int64_t span_us_;
  int64_t newest_ = INT64_MIN;
  std::deque<PoseTrack> tracks_;
  std::deque<TimedTilt> tilts_;
};

}  // namespace tread
