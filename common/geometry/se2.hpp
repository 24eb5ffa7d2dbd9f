// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Core>

namespace tread {

inline constexpr double kPi = 3.14159265358979323846;

/// Angle wrapped to (-pi, pi] [rad].
inline double wrapAngle(double angle) {
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

/// A pose in the plane, or the transform that it stands for: T_a_b holds the pose of frame b in
/// frame a.
/** Yaw is never wrapped, so that a trajectory may turn by more than half a turn. */
struct Pose2 {
  double x = 0.0;    ///< [m]
  double y = 0.0;    ///< [m]
  double yaw = 0.0;  ///< [rad], counter-clockwise, unwrapped

  Eigen::Vector2d position() const { return {x, y}; }
};

/// T_a_c = T_a_b * T_b_c; yaws add without wrapping.
inline Pose2 operator*(const Pose2& T_a_b, const Pose2& T_b_c) {
  const double c = std::cos(T_a_b.yaw);
  const double s = std::sin(T_a_b.yaw);
  return {T_a_b.x + c * T_b_c.x - s * T_b_c.y, T_a_b.y + s * T_b_c.x + c * T_b_c.y,
          T_a_b.yaw + T_b_c.yaw};
}

/// p_a = T_a_b * p_b.
inline Eigen::Vector2d operator*(const Pose2& T_a_b, const Eigen::Vector2d& p_b) {
  const double c = std::cos(T_a_b.yaw);
  const double s = std::sin(T_a_b.yaw);
  return {T_a_b.x + c * p_b.x() - s * p_b.y(), T_a_b.y + s * p_b.x() + c * p_b.y()};
}

/// T_b_a of a given T_a_b.
inline Pose2 inverse(const Pose2& T_a_b) {
  const double c = std::cos(T_a_b.yaw);
  const double s = std::sin(T_a_b.yaw);
  return {-c * T_a_b.x - s * T_a_b.y, s * T_a_b.x - c * T_a_b.y, -T_a_b.yaw};
}

/// T_b_c = inverse(T_a_b) * T_a_c; yaw difference unwrapped.
inline Pose2 between(const Pose2& T_a_b, const Pose2& T_a_c) {
  return inverse(T_a_b) * T_a_c;
}

inline double distanceBetween(const Pose2& a, const Pose2& b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

/// Length of a path from the origin through some poses [m].
inline double lengthOfPath(const std::vector<Pose2>& poses) {
  double length = 0.0;
  Pose2 last;
  for (const Pose2& pose : poses) {
    length += distanceBetween(last, pose);
    last = pose;
  }
  return length;
}

/// Body velocity of a planar motion.
struct Twist2 {
  double v_x = 0.0;    ///< forward [m/s]
  double v_y = 0.0;    ///< to the left [m/s]
  double omega = 0.0;  ///< yaw rate [rad/s], counter-clockwise positive
};

/// Pose after moving with a constant body twist for dt seconds, relative to the start (SE(2)
/// exponential).
inline Pose2 integrate(const Twist2& twist, double dt) {
  const double turn = twist.omega * dt;
  // Taylor series below 1e-6 rad: the quotients lose their digits there.
  const double sin_over = std::abs(turn) < 1e-6 ? 1.0 - turn * turn / 6.0 : std::sin(turn) / turn;
  // 1 - cos(turn) = 2 sin^2(turn / 2), which keeps the digits that the difference loses.
  const double sin_half = std::sin(turn / 2.0);
  const double cos_over = std::abs(turn) < 1e-6 ? turn / 2.0 : 2.0 * sin_half * sin_half / turn;
  return {dt * (sin_over * twist.v_x - cos_over * twist.v_y),
          dt * (cos_over * twist.v_x + sin_over * twist.v_y), turn};
}

/// Constant body twist that leads from the start to a relative pose in dt seconds (SE(2)
/// logarithm).
/** The inverse of integrate() for |yaw| < 2 pi. */
inline Twist2 twistTo(const Pose2& T_start_end, double dt) {
  const double half = T_start_end.yaw / 2.0;
  const double cot = std::abs(half) < 1e-6 ? 1.0 - half * half / 3.0 : half / std::tan(half);
  return {(cot * T_start_end.x + half * T_start_end.y) / dt,
          (-half * T_start_end.x + cot * T_start_end.y) / dt, T_start_end.yaw / dt};
}

/// A robot's rectangle in the body frame [m].
struct FootprintSize {
  double front = 0.0;       ///< from the body origin forward
  double rear = 0.0;        ///< and backward
  double half_width = 0.0;  ///< to both sides

  constexpr double length() const { return front + rear; }
  constexpr FootprintSize widened(double margin) const {
    return {front + margin, rear + margin, half_width + margin};
  }
};

}  // namespace tread
