// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/spatial_track.hpp"

#include <algorithm>

namespace tread::mapping {
namespace {

constexpr double kJumpMargin = 0.5;

}  // namespace

SpatialTrack::Verdict SpatialTrack::push(int64_t utime, const Eigen::Isometry3d& T_map_body) {
  Verdict verdict = Verdict::kTaken;
  if (!poses_.empty()) {
    if (utime <= poses_.back().utime) return Verdict::kNotNewer;
    const double dt = static_cast<double>(utime - poses_.back().utime) * 1e-6;
    const double way = (T_map_body.translation() - poses_.back().p_map).norm();
    if (way > top_speed_ * dt + kJumpMargin) {
      verdict = Verdict::kJump;
      poses_.clear();
    }
  }
  poses_.push_back({utime, T_map_body.translation(), Eigen::Quaterniond(T_map_body.linear())});
  while (poses_.front().utime < utime - span_us_) poses_.pop_front();
  return verdict;
}

std::optional<Eigen::Isometry3d> SpatialTrack::at(int64_t utime, int64_t max_gap_us) const {
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), utime,
                       [](const TimedPose& pose, int64_t time) { return pose.utime < time; });
  if (after == poses_.end()) return std::nullopt;
  const bool exact = after->utime == utime;
  if (!exact && after == poses_.begin()) return std::nullopt;
  const TimedPose& before = exact ? *after : *std::prev(after);
  const int64_t gap = after->utime - before.utime;
  if (gap > max_gap_us) return std::nullopt;
  const double share =
      exact ? 0.0 : static_cast<double>(utime - before.utime) / static_cast<double>(gap);
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = before.R_map_body.slerp(share, after->R_map_body).toRotationMatrix();
  T.translation() = before.p_map + share * (after->p_map - before.p_map);
  return T;
}

}  // namespace tread::mapping
