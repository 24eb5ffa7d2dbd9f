// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>

#include "common/geometry/track.hpp"

namespace tread {

/// What the INS said lately: tracks of poses, broken where the INS jumped, and the inclination
/// along them.
class TrackHistory {
 public:
  /// Keeps what is at most `span_us` older than the newest pose.
  explicit TrackHistory(int64_t span_us) : span_us_(span_us) {}

  /// Appends a pose; `inclination` [rad] NaN = unknown; `new_track`: not connected with what came
  /// before.
  /** Returns false if it is not newer than the last pose or not finite. */
  bool push(int64_t utime, const Pose2& T_map_body, double inclination, bool new_track);

  /// The track that was being driven at a time, or nullptr.
  const PoseTrack* covering(int64_t utime) const;

  /// Mean inclination [rad] of the poses in [from, to]; NaN if it is unknown there.
  double meanInclination(int64_t from, int64_t to) const;

  /// Time of the newest pose [us]; INT64_MIN before the first.
  int64_t newest() const { return newest_; }

 private:
  struct Inclination {
    int64_t utime;
    double angle;
  };

  int64_t span_us_;
  int64_t newest_ = INT64_MIN;
  std::deque<PoseTrack> tracks_;
  std::deque<Inclination> inclinations_;
};

}  // namespace tread
