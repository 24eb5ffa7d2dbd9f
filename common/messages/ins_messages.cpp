// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/ins_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread {
namespace {

bool hasPosition(const ins_t& ins) {
  return (ins.ins_status & ins_t::STATUS_NO_POSITION) == 0 && std::isfinite(ins.position[0]) &&
         std::isfinite(ins.position[1]);
}

std::optional<Eigen::Quaterniond> orientation(const ins_t& ins) {
  const Eigen::Quaterniond q(ins.orientation[0], ins.orientation[1], ins.orientation[2],
                             ins.orientation[3]);
  const double norm = q.norm();
  const bool known = (ins.ins_status & ins_t::STATUS_NO_HEADING) == 0;
  // A quaternion far from unit length is no rounding error but another field's bytes.
  if (!known || !std::isfinite(norm) || std::abs(norm - 1.0) > 1e-3) return std::nullopt;
  return q.normalized();
}

/// Ten seconds at 100 Hz; more cannot be waiting.
constexpr size_t kMaxWaitingPoses = 1000;
/// Clocks of the robot differ by less than this [us].
constexpr int64_t kMaxPoseAheadUs = 1'000'000;

}  // namespace

std::optional<Pose2> planarPose(const ins_t& ins) {
  const auto R_map_body = orientation(ins);
  if (!hasPosition(ins) || !R_map_body) return std::nullopt;
  return planar({ins.position[0], ins.position[1], ins.position[2]}, *R_map_body);
}

std::optional<Eigen::Isometry3d> spatialPose(const ins_t& ins) {
  const auto R_map_body = orientation(ins);
  if (!hasPosition(ins) || !std::isfinite(ins.position[2]) || !R_map_body) return std::nullopt;
  Eigen::Isometry3d T_map_body = Eigen::Isometry3d::Identity();
  T_map_body.linear() = R_map_body->toRotationMatrix();
  T_map_body.translation() = Eigen::Vector3d(ins.position[0], ins.position[1], ins.position[2]);
  return T_map_body;
}

std::optional<Twist2> planarTwist(const ins_t& ins) {
  const Twist2 twist{ins.velocity[0], ins.velocity[1], ins.rate[2]};
  const bool known = (ins.ins_status & ins_t::STATUS_NO_VELOCITY) == 0;
  if (!known || !std::isfinite(twist.v_x) || !std::isfinite(twist.v_y) ||
      !std::isfinite(twist.omega))
    return std::nullopt;
  return twist;
}

double horizontalStd(const ins_t& ins) {
  const auto& std = ins.position_std;
  const bool known = std::isfinite(std[0]) && std::isfinite(std[1]);
  return known ? std::max(std[0], std[1]) : std::numeric_limits<double>::quiet_NaN();
}

Tilt tilt(const ins_t& ins) {
  const auto orient = orientation(ins);
  if (!orient || (ins.ins_status & ins_t::STATUS_NO_ATTITUDE) != 0) return {};
  const Eigen::Matrix3d R_map_body = orient->toRotationMatrix();
  return {std::acos(std::min(1.0, std::max(-1.0, R_map_body(2, 2)))), R_map_body(2, 0),
          R_map_body(2, 1)};
}

void InsQueue::add(const ins_t& ins, int64_t now) {
  if (ins.utime <= 0 || ins.utime > now + kMaxPoseAheadUs) {
    ++invalid_;
    return;
  }
  if (begin_ == INT64_MIN) begin_ = ins.utime;
  if (ins.utime <= settled_ || waiting_.size() >= kMaxWaitingPoses) {
    ++too_late_;
    return;
  }
  waiting_[{ins.utime, ins.seq}] = ins;
}

void InsQueue::settle(int64_t horizon) {
  while (!waiting_.empty() && waiting_.begin()->first.first <= horizon) {
    append(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
  }
  settled_ = std::max(settled_, horizon);
}

void InsQueue::append(const ins_t& ins) {
  // A jump counts even if its own message has no pose: a new track follows.
  jumped_ = jumped_ || (ins.ins_status & ins_t::STATUS_JUMP) != 0;
  // Where device and scan matching alternate, the pose makes a step that the robot did not drive.
  const bool filled_in = (ins.ins_status & ins_t::STATUS_FILLED_IN) != 0;
  jumped_ = jumped_ || filled_in != filled_in_;
  filled_in_ = filled_in;
  const auto T_map_body = planarPose(ins);
  if (!T_map_body) {
    ++without_pose_;
    return;
  }
  if (history_.push(ins.utime, *T_map_body, tilt(ins), jumped_)) jumped_ = false;
}

}  // namespace tread
