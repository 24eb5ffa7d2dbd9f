// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/prediction.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {

Pose2 poseAlong(const std::vector<Pose2>& trajectory, double period, double time) {
  const double steps = std::clamp(time / period, 0.0, static_cast<double>(trajectory.size()));
  const auto whole = static_cast<size_t>(steps);
  const Pose2 before = whole == 0 ? Pose2{} : trajectory[whole - 1];
  if (whole == trajectory.size()) return before;
  const Twist2 twist = twistTo(between(before, trajectory[whole]), 1.0);
  return before * integrate(twist, steps - static_cast<double>(whole));
}

Prediction predict(const Pose2& T_map_body, double time, const TablePattern& pattern,
                   const PatternTable& table) {
  Prediction prediction;
  Pose2 T_map_now = T_map_body;
  if (time < 0.0) T_map_now = T_map_body * integrate(table.motionClass(pattern.entry).twist, -time);
  const double period = table.set().periodSeconds();
  const Pose2 T_start_now = poseAlong(pattern.pattern->trajectory, period, time);
  const Pose2 T_map_start = T_map_now * inverse(T_start_now);
  for (const SweepPose& at : pattern.sweep)
    if (at.time > time) prediction.ahead.push_back({T_map_start * at.pose, at.time - time});
  prediction.T_map_end = T_map_start * pattern.end().pose;
  prediction.time_left = pattern.duration - time;
  const double share = std::clamp(prediction.time_left / pattern.duration, 0.0, 1.0);
  prediction.variance = share * pattern.variance;
  return prediction;
}

std::optional<double> firstConflict(const Surroundings& surroundings,
                                    const std::vector<ExpectedPose>& poses, int level) {
  for (const ExpectedPose& at : poses)
    if (!surroundings.isFree(at.T_map_body, level)) return at.time;
  return std::nullopt;
}

}  // namespace tread::planner
