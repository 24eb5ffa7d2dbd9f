// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/search/prediction.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {
namespace {

/// So much motion may be noise or a moment's disturbance [m, rad].
constexpr double kWayDoubt = 0.3;
constexpr double kTurnDoubt = 0.15;
constexpr double kLeastRatio = 0.6;
constexpr double kMostRatio = 1.6;

}  // namespace

MotionRatio motionRatio(const Pose2& T_start_now, double time, const TablePattern& pattern,
                        double period) {
  const Pose2 expected = poseAlong(pattern.pattern->trajectory, period, time);
  const auto ratio = [](double measured, double promised, double doubt) {
    return std::clamp((measured + doubt) / (promised + doubt), kLeastRatio, kMostRatio);
  };
  MotionRatio so_far;
  // Along the way that was expected: sideways slip is not more way.
  const double length = std::hypot(expected.x, expected.y);
  const double along =
      length > 0.0 ? (T_start_now.x * expected.x + T_start_now.y * expected.y) / length : 0.0;
  so_far.way = ratio(along, length, kWayDoubt);
  const double sign = expected.yaw < 0.0 ? -1.0 : 1.0;
  so_far.turn = ratio(sign * T_start_now.yaw, sign * expected.yaw, kTurnDoubt);
  return so_far;
}

Prediction predict(const Pose2& T_map_body, double time, const TablePattern& pattern,
                   const PatternTable& table, const MotionRatio& so_far) {
  Prediction prediction;
  Pose2 pose = T_map_body;
  if (time < 0.0) pose = pose * integrate(table.motionClass(pattern.entry).twist, -time);
  const double period = table.set().periodSeconds();
  Pose2 before = poseAlong(pattern.pattern->trajectory, period, time);
  for (const SweptPose& at : pattern.swept_poses) {
    if (at.time <= time) continue;
    const Pose2 step = between(before, at.pose);
    pose = pose * Pose2{so_far.way * step.x, so_far.way * step.y, so_far.turn * step.yaw};
    before = at.pose;
    prediction.ahead.push_back({pose, at.time - time});
  }
  prediction.T_map_end = pose;
  prediction.time_left = pattern.duration - time;
  const double share = std::clamp(prediction.time_left / pattern.duration, 0.0, 1.0);
  prediction.uncertainty = scaled(pattern.uncertainty, share, T_map_body.yaw);
  return prediction;
}

std::optional<double> firstConflict(const CollisionChecker& collision_checker,
                                    const std::vector<ExpectedPose>& poses, int level) {
  for (const ExpectedPose& at : poses)
    if (!collision_checker.isFree(at.T_map_body, level)) return at.time;
  return std::nullopt;
}

bool leftCorridor(const Prediction& then, const Prediction& now) {
  constexpr double kSigmas = 3.0;
  constexpr double kLeastWay = 0.1;   // [m]
  constexpr double kLeastTurn = 0.1;  // [rad]
  const Pose2 off = between(then.T_map_end, now.T_map_end);
  const double way = kSigmas * std::sqrt(static_cast<double>(then.uncertainty.position()));
  const double turn = kSigmas * std::sqrt(static_cast<double>(then.uncertainty.yawyaw));
  return std::hypot(off.x, off.y) > std::max(kLeastWay, way) ||
         std::abs(wrapAngle(off.yaw)) > std::max(kLeastTurn, turn);
}

}  // namespace tread::planner
