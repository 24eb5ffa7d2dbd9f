// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/execution/track_history.hpp"

#include <cmath>
#include <limits>

namespace tread {

bool TrackHistory::push(int64_t utime, const Pose2& T_map_body, double inclination,
                        bool new_track) {
  if (utime <= newest_) return false;
  PoseTrack fresh(span_us_);
  if (!tracks_.empty() && !new_track) {
    if (!tracks_.back().push(utime, T_map_body)) return false;
  } else {
    if (!fresh.push(utime, T_map_body)) return false;
    tracks_.push_back(std::move(fresh));
  }
  newest_ = utime;
  if (std::isfinite(inclination)) inclinations_.push_back({utime, inclination});
  while (tracks_.front().poses().back().utime < utime - span_us_) tracks_.pop_front();
  while (!inclinations_.empty() && inclinations_.front().utime < utime - span_us_)
    inclinations_.pop_front();
  return true;
}

const PoseTrack* TrackHistory::covering(int64_t utime) const {
  for (const PoseTrack& track : tracks_)
    if (track.poses().front().utime <= utime && utime <= track.poses().back().utime) return &track;
  return nullptr;
}

double TrackHistory::meanInclination(int64_t from, int64_t to) const {
  double sum = 0.0;
  int count = 0;
  for (const Inclination& sample : inclinations_) {
    if (sample.utime < from || sample.utime > to) continue;
    sum += sample.angle;
    ++count;
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace tread
