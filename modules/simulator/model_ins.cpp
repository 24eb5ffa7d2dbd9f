// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/model_ins.hpp"

#include <algorithm>
#include <cmath>

namespace tread::sim {
namespace {

constexpr double kMemory = 4.0;  // [s], longer than both latencies together
constexpr size_t kMostRemembered = 1000;

}  // namespace

void ModelIns::remember(const MotionSample& now, const InsInput& truth) {
  motion_.push_back(now);
  truths_.push_back(truth);
  if (motion_.size() < kMostRemembered) return;
  const auto old = std::find_if(motion_.begin(), motion_.end(), [&](const MotionSample& pose) {
    return pose.time >= now.time - kMemory;
  });
  truths_.erase(truths_.begin(), truths_.begin() + (old - motion_.begin()));
  motion_.erase(motion_.begin(), old);
}

InsInput ModelIns::inputAt(double time) const {
  const auto earlier = std::find_if(motion_.rbegin(), motion_.rend(),
                                    [&](const MotionSample& pose) { return pose.time <= time; });
  if (earlier == motion_.rend()) return truths_.front();
  const size_t i = static_cast<size_t>(motion_.rend() - earlier) - 1;
  if (i + 1 == motion_.size()) return truths_.back();
  const double share = (time - motion_[i].time) / (motion_[i + 1].time - motion_[i].time);
  InsInput input = truths_[i];
  const InsInput& next = truths_[i + 1];
  input.body.p_map += share * (next.body.p_map - input.body.p_map);
  input.body.pitch += share * (next.body.pitch - input.body.pitch);
  input.body.roll += share * (next.body.roll - input.body.roll);
  input.v_body += share * (next.v_body - input.v_body);
  input.rate_body += share * (next.rate_body - input.rate_body);
  return input;
}

InsInput ModelIns::sensed(int64_t utime, const InsInput& truth) {
  const double now = static_cast<double>(utime - start_utime_) * 1e-6;
  const Eigen::Vector3d& p_map = truth.body.p_map;
  remember({now, {p_map.x(), p_map.y(), truth.yaw}, truth.rate_body.z()}, truth);
  const MotionSample said = measuredAt(motion_, measurement_, now);
  const double then = now - measurement_.ins_latency;
  InsInput input = inputAt(then);
  const double omega = yawRateAt(motion_, then);
  const double ahead = poseAt(motion_, then).yaw - said.T_map_body.yaw;
  const double scale = 1.0 + measurement_.position_scale;
  const double v_x = scale * (input.v_body.x() + measurement_.lever_arm_y * omega);
  const double v_y = scale * (input.v_body.y() - measurement_.lever_arm_x * omega);
  const double c = std::cos(ahead), s = std::sin(ahead);
  input.v_body.x() = c * v_x - s * v_y;
  input.v_body.y() = s * v_x + c * v_y;
  input.body.p_map.x() = said.T_map_body.x;
  input.body.p_map.y() = said.T_map_body.y;
  input.yaw = said.T_map_body.yaw;
  input.rate_body.z() = said.omega;
  return input;
}

}  // namespace tread::sim
