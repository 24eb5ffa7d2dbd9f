// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/omni_kernel.hpp"

#include <algorithm>
#include <cmath>

namespace tread {
namespace {

constexpr double kRoundingOfTime = 1e-12;  // [s]

}  // namespace

OmniKernel::OmniKernel(const VehicleModel& model, const Command& entry, const ExecutionNoise& noise)
    : model_(model), noise_(noise), driven_(asked(entry)), asked_(driven_) {}

Twist2 OmniKernel::asked(const Command& command) const {
  const double unit = model_.kind == CommandKind::kTrackSpeed ? 1.0 : model_.full_speed;
  const Twist2 twist = model_.wheels.twist(command);
  return {unit * twist.v_x, unit * twist.v_y, unit * twist.omega};
}

Twist2 OmniKernel::onGround(const Twist2& driven) const {
  const double v_x = noise_.forward * model_.forward_gain * driven.v_x;
  const double v_y = noise_.forward * model_.sideways_gain * driven.v_y;
  const double c = std::cos(noise_.crab), s = std::sin(noise_.crab);
  return {c * v_x - s * v_y, s * v_x + c * v_y, noise_.yaw * model_.yaw_gain * driven.omega};
}

void OmniKernel::step(const Command& command, double duration) {
  waiting_.push_back({time_ + model_.delay, command});
  const double end = time_ + duration;
  while (!waiting_.empty() && waiting_.front().until < end - kRoundingOfTime) {
    advance(waiting_.front().until - time_);
    asked_ = asked(waiting_.front().command);
    waiting_.pop_front();
  }
  advance(end - time_);
  time_ = end;
}

void OmniKernel::advance(double duration) {
  if (duration < kRoundingOfTime) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(duration / model_.step - 1e-6)));
  const double dt = duration / steps;
  for (int i = 0; i < steps; ++i) {
    const Followed x = follow(driven_.v_x, asked_.v_x, model_.lag, dt);
    const Followed y = follow(driven_.v_y, asked_.v_y, model_.lag, dt);
    const Followed turn = follow(driven_.omega, asked_.omega, model_.lag, dt);
    T_start_body_ = T_start_body_ * integrate(onGround({x.mean, y.mean, turn.mean}), dt);
    driven_ = {x.end, y.end, turn.end};
  }
  time_ += duration;
}

}  // namespace tread
