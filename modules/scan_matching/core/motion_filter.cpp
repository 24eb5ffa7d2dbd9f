// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/scan_matching/core/motion_filter.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace tread::scan_matching {

using Eigen::Matrix3d;
using Eigen::Vector3d;

MotionFilter::MotionFilter(const MotionConfig& config, const Pose2& T_map_body)
    : config_(config), pose_(T_map_body) {
  covariance_.diagonal().tail<3>().setConstant(config.start_speed * config.start_speed);
}

void MotionFilter::predict(double dt) {
  const Pose2 step = integrate(twist_, dt);
  // Halfway the body has turned by half.
  const double c = std::cos(pose_.yaw + step.yaw / 2.0);
  const double s = std::sin(pose_.yaw + step.yaw / 2.0);
  const Pose2 next = pose_ * step;
  const double dx = next.x - pose_.x;
  const double dy = next.y - pose_.y;
  Matrix3d turning = Matrix3d::Identity();  // d pose / d pose
  turning(0, 2) = -dy;
  turning(1, 2) = dx;
  Matrix3d moving = Matrix3d::Zero();  // d pose / d twist, per second
  moving << c, -s, -dy / 2.0, s, c, dx / 2.0, 0.0, 0.0, 1.0;
  Covariance F = Covariance::Identity();
  F.topLeftCorner<3, 3>() = turning;
  F.topRightCorner<3, 3>() = dt * moving;
  // White acceleration of this density changes the speed as much as one that lasts for
  // `correlation`.
  const double a = config_.acceleration * config_.acceleration * config_.correlation;
  const double w = config_.yaw_acceleration * config_.yaw_acceleration * config_.correlation;
  const Matrix3d density = Vector3d(a, a, w).asDiagonal();
  Covariance Q;
  Q.topLeftCorner<3, 3>() = dt * dt * dt / 3.0 * moving * density * moving.transpose();
  Q.topRightCorner<3, 3>() = dt * dt / 2.0 * moving * density;
  Q.bottomLeftCorner<3, 3>() = Q.topRightCorner<3, 3>().transpose();
  Q.bottomRightCorner<3, 3>() = dt * density;
  covariance_ = F * covariance_ * F.transpose() + Q;
  pose_ = next;
  limitTwist();
}

void MotionFilter::constrain(double dt, bool standing) {
  // As one measurement per correlation time, for any rate of scans.
  const double count = dt / config_.correlation;
  const auto variance = [&](double std) { return std * std / std::max(1e-6, count); };
  if (!standing) return measureTwist(1, variance(config_.lateral_speed));
  for (int axis = 0; axis < 3; ++axis) measureTwist(axis, variance(config_.standing_speed));
}

/// One component of the twist is zero, up to this variance.
void MotionFilter::measureTwist(int axis, double variance) {
  const double value = axis == 0 ? twist_.v_x : axis == 1 ? twist_.v_y : twist_.omega;
  const Eigen::Matrix<double, 6, 1> column = covariance_.col(3 + axis);
  const double total = column[3 + axis] + variance;
  const Eigen::Matrix<double, 6, 1> change = column * (-value / total);
  pose_ = {pose_.x + change[0], pose_.y + change[1], pose_.yaw + change[2]};
  twist_ = {twist_.v_x + change[3], twist_.v_y + change[4], twist_.omega + change[5]};
  covariance_ -= column * column.transpose() / total;
}

/// A body never exceeds its top speed, however large the uncertainty.
void MotionFilter::limitTwist() {
  const double most[3] = {config_.speed, config_.speed, config_.yaw_rate};
  for (int i = 0; i < 3; ++i) {
    const double share = most[i] / std::sqrt(covariance_(3 + i, 3 + i));
    if (share >= 1.0) continue;
    covariance_.row(3 + i) *= share;
    covariance_.col(3 + i) *= share;
  }
}

void MotionFilter::update(const Pose2& T_map_body, const Matrix3d& covariance) {
  const Matrix3d P = poseCovariance();
  // Information about the pose is transferred to the twist by their correlation.
  const Matrix3d gain = covariance_.bottomLeftCorner<3, 3>() * P.inverse();
  const Vector3d change(T_map_body.x - pose_.x, T_map_body.y - pose_.y,
                        wrapAngle(T_map_body.yaw - pose_.yaw));
  const Vector3d twist = Vector3d(twist_.v_x, twist_.v_y, twist_.omega) + gain * change;
  twist_ = {twist[0], twist[1], twist[2]};
  pose_ = {T_map_body.x, T_map_body.y, pose_.yaw + change[2]};
  covariance_.bottomRightCorner<3, 3>() -= gain * (P - covariance) * gain.transpose();
  covariance_.bottomLeftCorner<3, 3>() = gain * covariance;
  covariance_.topRightCorner<3, 3>() = covariance_.bottomLeftCorner<3, 3>().transpose();
  covariance_.topLeftCorner<3, 3>() = covariance;
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

void MotionFilter::anchor() {
  covariance_.topRows<3>().setZero();
  covariance_.leftCols<3>().setZero();
}

}  // namespace tread::scan_matching
