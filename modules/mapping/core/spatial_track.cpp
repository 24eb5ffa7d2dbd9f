// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/core/spatial_track.hpp"

#include <algorithm>

#include "common/geometry/se3.hpp"

namespace tread::mapping {
namespace {

/// Excess of a step over the top speed's that is noise of the INS [m].
constexpr double kStepMargin = 0.5;
/// Doubted poses that must agree with each other to be accepted.
constexpr size_t kEnoughDoubted = 3;

}  // namespace

void SpatialTrack::clear() {
  poses_.clear();
  doubted_.clear();
}

bool SpatialTrack::follows(const SpatialPose& next, const SpatialPose& before) const {
  const double dt = static_cast<double>(next.utime - before.utime) * 1e-6;
  const Eigen::Vector3d step = next.T_map_body.translation() - before.T_map_body.translation();
  return dt > 0.0 && step.norm() <= top_speed_ * dt + kStepMargin;
}

SpatialTrack::PoseCheck SpatialTrack::push(int64_t utime, const Eigen::Isometry3d& T_map_body) {
  if (utime < 0 || (!poses_.empty() && utime <= newest())) return PoseCheck::kNotNewer;
  const SpatialPose pose{utime, T_map_body};
  if (!poses_.empty() && !follows(pose, poses_.back())) return doubt(pose);
  doubted_.clear();
  append(pose);
  return PoseCheck::kTaken;
}

SpatialTrack::PoseCheck SpatialTrack::doubt(const SpatialPose& pose) {
  if (!doubted_.empty() && !follows(pose, doubted_.back())) doubted_.clear();
  doubted_.push_back(pose);
  if (doubted_.size() < kEnoughDoubted) return PoseCheck::kDoubted;
  poses_.clear();
  for (const SpatialPose& believed : doubted_) append(believed);
  doubted_.clear();
  return PoseCheck::kJump;
}

void SpatialTrack::append(const SpatialPose& pose) {
  poses_.push_back(pose);
  while (poses_.front().utime < pose.utime - span_us_) poses_.pop_front();
}

std::optional<Eigen::Isometry3d> SpatialTrack::at(int64_t utime, int64_t max_gap_us) const {
  const auto after =
      std::lower_bound(poses_.begin(), poses_.end(), utime,
                       [](const SpatialPose& pose, int64_t time) { return pose.utime < time; });
  if (after == poses_.end()) return std::nullopt;
  const bool exact = after->utime == utime;
  if (!exact && after == poses_.begin()) return std::nullopt;
  const SpatialPose& before = exact ? *after : *std::prev(after);
  const int64_t gap = after->utime - before.utime;
  if (gap > max_gap_us) return std::nullopt;
  const double share =
      exact ? 0.0 : static_cast<double>(utime - before.utime) / static_cast<double>(gap);
  return interpolated(before.T_map_body, after->T_map_body, share);
}

}  // namespace tread::mapping
