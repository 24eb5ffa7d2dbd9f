// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/omni_kernel.hpp"

#include <algorithm>
#include <cmath>

namespace tread {
namespace {

using namespace steps;

constexpr double kRoundingOfTime = 1e-12;  // [s]

double lossOf(const EffectValues& effects, size_t wheel) {
  static constexpr double EffectValues::*kLosses[] = {
      &EffectValues::wheel_1_loss, &EffectValues::wheel_2_loss, &EffectValues::wheel_3_loss,
      &EffectValues::wheel_4_loss};
  return wheel < std::size(kLosses) ? effects.*kLosses[wheel] : 0.0;
}

}  // namespace

OmniKernel::OmniKernel(const VehicleModel& model, const Command& entry, const ExecutionNoise& noise,
                       const DriveContext& context, const std::optional<Command>& known)
    : model_(model), noise_(noise), context_(context), acting_(entry) {
  Command rims;
  for (size_t wheel = 0; wheel < model_.wheels.size(); ++wheel) {
    rims[wheel] = known ? (*known)[wheel] : target(wheel, supplied(wheel));
    rims_[wheel] = {rims[wheel], rims[wheel], 0.0, 0.0};
  }
  body_ = onGround(rims, changesAt(model_.effects, context_.session_time, 0.0));
}

double OmniKernel::supplied(size_t wheel) const {
  return suppliedSpeed(model_.effects, model_.unit() * acting_[wheel], context_.session_time,
                       context_.battery_drop);
}

double OmniKernel::target(size_t wheel, double supply) const {
  const EffectValues& effects = model_.effects;
  if (effects.thermal_derating != 0.0)
    supply *= std::max(0.0, 1.0 - effects.thermal_derating * rims_[wheel].heat);
  const double loss = lossOf(effects, wheel);
  return loss == 0.0 ? supply : supply * (1.0 - loss);
}

Twist2 OmniKernel::onGround(const Command& rims, const ChangesInForce& changes) const {
  const EffectValues& effects = model_.effects;
  const Twist2 driven = model_.wheels.twist(rims);
  const double grip =
      1.0 - effects.slip_ratio - on(effects.terrain_slip_1, effects.terrain_slip_2, changes);
  const double moved = noise_.forward * grip * (1.0 - effects.translation_loss);
  const double forward = moved * model_.forward_gain;
  const double sideways = moved * (model_.sideways_gain - effects.sideways_loss);
  Twist2 motion{forward * driven.v_x, sideways * driven.v_y, 0.0};
  motion.omega =
      turned(effects, changes, motion.v_x, noise_.yaw * grip * model_.yaw_gain * driven.omega);
  motion.omega += effects.yaw_pull * motion.v_x + effects.sideways_turn * motion.v_y;
  motion.omega += effects.yaw_rate_offset;
  const double speed = std::hypot(motion.v_x, motion.v_y);
  if (speed > 0.0) {
    const double kept = slowed(effects, changes, speed, motion.omega) / speed;
    motion.v_x *= kept;
    motion.v_y *= kept;
  }
  return motion;
}

Twist2 OmniKernel::bodyTwist(const Twist2& motion, const ChangesInForce& changes,
                             double fastest) const {
  const EffectValues& effects = model_.effects;
  const double c = std::cos(noise_.crab + effects.crab), s = std::sin(noise_.crab + effects.crab);
  Twist2 v_body{c * motion.v_x - s * motion.v_y, s * motion.v_x + c * motion.v_y, motion.omega};
  v_body.v_y -= (effects.icr_offset + effects.payload_icr * changes.payload) * motion.omega;
  const double pull = kGravity * std::min(1.0, fastest / kSlopeFullSpeed);
  v_body.v_x += effects.slope_pitch * pull * std::sin(context_.pitch);  // nose-down is positive
  v_body.v_y -= effects.slope_roll * pull * std::sin(context_.roll);
  return v_body;
}

Twist2 OmniKernel::twist() const {
  const EffectValues& effects = model_.effects;
  const ChangesInForce changes = changesAt(effects, context_.session_time, 0.0);
  Command rims;
  double fastest = 0.0;
  for (size_t wheel = 0; wheel < model_.wheels.size(); ++wheel) {
    rims[wheel] = rims_[wheel].speed;
    fastest = std::max(fastest, std::abs(rims[wheel]));
  }
  Twist2 motion = onGround(rims, changes);
  if (effects.body_inertia > 0.0) motion.v_x = body_.v_x;
  if (effects.body_inertia + effects.sideways_lag > 0.0) motion.v_y = body_.v_y;
  if (effects.yaw_inertia > 0.0) motion.omega = body_.omega;
  return bodyTwist(motion, changes, fastest);
}

void OmniKernel::step(const Command& command, double duration) {
  give(command);
  hold(duration);
}

void OmniKernel::give(const Command& command) {
  waiting_.push_back({time_ + model_.commandDelay(), command});
}

void OmniKernel::hold(double duration, const DriveContext& context) {
  context_ = context;
  hold(duration);
}

void OmniKernel::hold(double duration) {
  const double end = time_ + duration;
  while (!waiting_.empty() && waiting_.front().until < end - kRoundingOfTime) {
    advance(waiting_.front().until - time_);
    acting_ = waiting_.front().command;
    waiting_.pop_front();
  }
  advance(end - time_);
  time_ = end;
}

void OmniKernel::advance(double duration) {
  if (duration < kRoundingOfTime) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(duration / model_.step - 1e-6)));
  const double dt = duration / steps;
  for (int i = 0; i < steps; ++i) integrateStep(dt);
  time_ += duration;
}

void OmniKernel::integrateStep(double dt) {
  const EffectValues& effects = model_.effects;
  Command rims;
  double fastest = 0.0;
  for (size_t wheel = 0; wheel < model_.wheels.size(); ++wheel) {
    const double supply = supplied(wheel);
    rims[wheel] = driveTrack(model_, supply, target(wheel, supply), dt, rims_[wheel]);
    fastest = std::max(fastest, std::abs(rims[wheel]));
  }
  const ChangesInForce changes = changesAt(effects, context_.session_time, dt);
  const Twist2 steady = onGround(rims, changes);
  const Followed x = follow(body_.v_x, steady.v_x, effects.body_inertia, dt);
  const Followed y = follow(body_.v_y, steady.v_y, effects.body_inertia + effects.sideways_lag, dt);
  const Followed turn = follow(body_.omega, steady.omega, effects.yaw_inertia, dt);
  body_ = {x.end, y.end, turn.end};
  T_start_body_ =
      T_start_body_ * integrate(bodyTwist({x.mean, y.mean, turn.mean}, changes, fastest), dt);
  context_.session_time += dt;
}

}  // namespace tread
