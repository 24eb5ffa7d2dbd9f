// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/geometry/track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread {
namespace {

bool isFinite(const Pose2& pose) {
  return std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.yaw);
}

}  // namespace

bool PoseTrack::push(int64_t utime, const Pose2& T_map_body) {
  if (utime < 0 || !isFinite(T_map_body)) return false;
  Pose2 continuous = T_map_body;
  if (!poses_.empty()) {
    if (utime <= poses_.back().utime) return false;
    const double last_yaw = poses_.back().T_map_body.yaw;
    continuous.yaw = last_yaw + wrapAngle(T_map_body.yaw - last_yaw);
  }
  poses_.push_back({utime, continuous});
  while (poses_.front().utime < utime - span_us_) poses_.pop_front();
  return true;
}

std::optional<Pose2> PoseTrack::at(int64_t utime, int64_t max_gap_us) const {
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), utime,
                       [](const TimedPose& pose, int64_t time) { return pose.utime < time; });
  if (after == poses_.end()) return std::nullopt;
  if (after->utime == utime) return after->T_map_body;
  if (after == poses_.begin()) return std::nullopt;
  const TimedPose& before = *std::prev(after);
  const int64_t gap = after->utime - before.utime;
  if (gap > max_gap_us) return std::nullopt;
  const double share = static_cast<double>(utime - before.utime) / static_cast<double>(gap);
  const Twist2 step = twistTo(between(before.T_map_body, after->T_map_body), 1.0);
  return before.T_map_body * integrate(step, share);
}

std::optional<int64_t> PoseTrack::longestGap(int64_t from, int64_t to) const {
  if (poses_.empty() || poses_.front().utime > from || poses_.back().utime < to)
    return std::nullopt;
  int64_t longest = 0;
  for (size_t i = 1; i < poses_.size(); ++i) {
    if (poses_[i].utime <= from || poses_[i - 1].utime >= to) continue;
    longest = std::max(longest, poses_[i].utime - poses_[i - 1].utime);
  }
  return longest;
}

std::optional<Twist2> PoseTrack::twistBefore(int64_t utime, int64_t window_us,
                                             int64_t max_gap_us) const {
  const auto first = at(utime - window_us, max_gap_us);
  const auto last = at(utime, max_gap_us);
  if (!first || !last) return std::nullopt;
  return twistTo(between(*first, *last), static_cast<double>(window_us) * 1e-6);
}

bool TrackHistory::push(int64_t utime, const Pose2& T_map_body, const Tilt& tilt, bool new_track) {
  if (utime <= newest_) return false;
  PoseTrack fresh(span_us_);
  if (!tracks_.empty() && !new_track) {
    if (!tracks_.back().push(utime, T_map_body)) return false;
  } else {
    if (!fresh.push(utime, T_map_body)) return false;
    tracks_.push_back(std::move(fresh));
  }
  newest_ = utime;
  if (std::isfinite(tilt.inclination)) tilts_.push_back({utime, tilt});
  while (tracks_.front().poses().back().utime < utime - span_us_) tracks_.pop_front();
  while (!tilts_.empty() && tilts_.front().utime < utime - span_us_) tilts_.pop_front();
  return true;
}

const PoseTrack* TrackHistory::covering(int64_t utime) const {
  for (const PoseTrack& track : tracks_)
    if (track.poses().front().utime <= utime && utime <= track.poses().back().utime) return &track;
  return nullptr;
}

Tilt TrackHistory::meanTilt(int64_t from, int64_t to) const {
  Tilt sum{0.0, 0.0, 0.0};
  int count = 0;
  for (const auto& [utime, tilt] : tilts_) {
    if (utime < from || utime > to) continue;
    sum.inclination += tilt.inclination;
    sum.ahead += tilt.ahead;
    sum.left += tilt.left;
    ++count;
  }
  if (count == 0) return {};
  return {sum.inclination / count, sum.ahead / count, sum.left / count};
}

}  // namespace tread
