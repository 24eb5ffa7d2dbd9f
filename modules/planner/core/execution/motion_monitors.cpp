// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/motion_monitors.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {

void StandstillDetector::take(const PoseReading& pose) {
  if (!poses_.empty() && pose.utime <= poses_.back().utime) return;
  poses_.push_back(pose);
  while (poses_.size() > 2 && poses_[1].utime <= pose.utime - kMoment) poses_.pop_front();
}

bool StandstillDetector::stands(int64_t since) const {
  if (poses_.empty() || poses_.front().utime < since ||
      poses_.back().utime - poses_.front().utime < kMoment)
    return false;
  if (poses_.back().twist) {
    return std::all_of(poses_.begin(), poses_.end(), [](const PoseReading& pose) {
      return pose.twist && std::hypot(pose.twist->v_x, pose.twist->v_y) < kSlow &&
             std::abs(pose.twist->omega) < kSlow;
    });
  }
  const Pose2 moved = between(poses_.front().T_map_body, poses_.back().T_map_body);
  const double seconds = static_cast<double>(kMoment) * 1e-6;
  return std::hypot(moved.x, moved.y) < kSlow * seconds &&
         std::abs(wrapAngle(moved.yaw)) < kSlow * seconds;
}

void ProgressMonitor::restart(int64_t now) {
  since_ = now;
  any_ = false;
  dead_ends_ = 0;
}

bool ProgressMonitor::stuck(double way_to_go, int64_t now) {
  const bool nearer = !any_ || way_to_go < best_ - kProgress;
  const bool dead_end = any_ && way_to_go > best_ + kDeadEnd && dead_ends_ < kDeadEnds;
  if (dead_end) ++dead_ends_;
  if (nearer || dead_end) {
    best_ = way_to_go;
    any_ = true;
    since_ = now;
    return false;
  }
  if (now - since_ < patience_) return false;
  since_ = now;
  best_ = way_to_go;
  return true;
}

}  // namespace tread::planner
