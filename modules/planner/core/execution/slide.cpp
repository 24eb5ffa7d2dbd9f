// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/slide.hpp"

#include <algorithm>
#include <cmath>

#include "modules/planner/core/search/swept_footprint.hpp"

namespace tread::planner {
namespace {

constexpr double kLeastSlide = 0.25;  // [m/s] as the learner's
constexpr double kSlideShare = 0.15;  // [1] of the speed
constexpr double kSlideStep = 0.1;    // [s]
constexpr double kStands = 0.05;      // [m/s]
constexpr double kBetter = 0.1;       // [m/s] smaller differences are no improvement

/// Advances it by a step; false if it then hits something.
bool slideOn(const CollisionChecker& around, const Twist2& asked, Sliding& vehicle, double dt) {
  const Pose2& at = vehicle.T_map_body;
  const Eigen::Vector2d wanted = Pose2{0.0, 0.0, at.yaw} * Eigen::Vector2d(asked.v_x, asked.v_y);
  const Eigen::Vector2d change = wanted - vehicle.v_map;
  const double most = vehicle.deceleration * dt;
  const Eigen::Vector2d before = vehicle.v_map;
  vehicle.v_map += change.norm() > most ? Eigen::Vector2d(most * change.normalized()) : change;
  const Eigen::Vector2d p = at.position() + 0.5 * dt * (before + vehicle.v_map);
  vehicle.T_map_body = {p.x(), p.y(), at.yaw + asked.omega * dt};
  return around.isFree(vehicle.T_map_body, CollisionChecker::kBare);
}

}  // namespace

bool slides(const Twist2& measured, const Twist2& asked) {
  const double speed = std::hypot(measured.v_x, measured.v_y);
  const double least = std::max(kLeastSlide, kSlideShare * speed);
  const bool on =
      measured.v_x * asked.v_x >= 0.0 && std::abs(measured.v_x) - std::abs(asked.v_x) > least;
  return on || std::abs(measured.v_y - asked.v_y) > least;
}

std::vector<AskedMotion> askedFrom(const MotionPattern& pattern, double period, double time) {
  std::vector<AskedMotion> asked;
  const double end = period * static_cast<double>(pattern.trajectory.size());
  for (double t = std::max(0.0, time); t < end - 1e-6; t += kSlideStep) {
    const double seconds = std::min(kSlideStep, end - t);
    const Pose2 from = poseAlong(pattern.trajectory, period, t);
    const Pose2 to = poseAlong(pattern.trajectory, period, t + seconds);
    asked.push_back({twistTo(between(from, to), seconds), seconds});
  }
  return asked;
}

double impactSpeed(const CollisionChecker& around, Sliding vehicle,
                   const std::vector<AskedMotion>& asked) {
  for (const AskedMotion& motion : asked)
    if (!slideOn(around, motion.v_body, vehicle, motion.seconds)) return vehicle.v_map.norm();
  while (vehicle.v_map.norm() > kStands)
    if (!slideOn(around, {}, vehicle, kSlideStep)) return vehicle.v_map.norm();
  return 0.0;
}

SlideAnswer answerToSlide(const CollisionChecker& around, const Sliding& vehicle,
                          const SlideChoices& choices, double period) {
  const auto followedBy = [&](const TablePattern* next) {
    std::vector<AskedMotion> asked = choices.rest;
    if (next != nullptr)
      for (const AskedMotion& motion : askedFrom(*next->pattern, period, 0.0))
        asked.push_back(motion);
    return impactSpeed(around, vehicle, asked);
  };
  SlideAnswer best{SlideAnswer::Kind::kGoOn, nullptr, followedBy(choices.next)};
  const auto consider = [&](const SlideAnswer& other) {
    if (other.impact < best.impact - kBetter || (other.impact == 0.0 && best.impact > 0.0))
      best = other;
  };
  if (best.impact == 0.0) return best;
  consider({SlideAnswer::Kind::kStop, nullptr, impactSpeed(around, vehicle, {})});
  for (const TablePattern* follower : choices.followers)
    consider({SlideAnswer::Kind::kFollow, follower, followedBy(follower)});
  return best;
}

}  // namespace tread::planner
