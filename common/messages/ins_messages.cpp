// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/ins_messages.hpp"

#include <cmath>

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
  // A quaternion far from unit length is not a rounding error but another field's bytes.
  if (!known || !std::isfinite(norm) || std::abs(norm - 1.0) > 1e-3) return std::nullopt;
  return q.normalized();
}

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

std::optional<double> inclination(const ins_t& ins) {
  const auto R_map_body = orientation(ins);
  if (!R_map_body || (ins.ins_status & ins_t::STATUS_NO_ATTITUDE) != 0) return std::nullopt;
  const double up = (*R_map_body * Eigen::Vector3d::UnitZ()).z();
  return std::acos(std::min(1.0, std::max(-1.0, up)));
}

}  // namespace tread
