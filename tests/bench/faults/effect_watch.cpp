// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/effect_watch.hpp"

#include <algorithm>
#include <cmath>

namespace tread::faults {
namespace {

constexpr int64_t kTogether = 20'000;    // [us] window for a fault that stops the motors at once
constexpr int64_t kStands = 500'000;     // [us] of zero commands
constexpr int64_t kForGood = 3'000'000;  // [us] longer than the pause before a turn

double seconds(int64_t us) {
  return static_cast<double>(us) * 1e-6;
}

}  // namespace

void EffectWatch::receive(const health_t& health) {
  const bool failed = health.process == "mapping" && health.health_state == health_t::HEALTH_FAILED;
  named_ = named_ || (begun_ && failed);
}

void EffectWatch::receive(const motor_t& motor) {
  disarmed_ = !mayDrive(motor.bridge_state);
  motor_reason_ = motor.state_reason;
}

void EffectWatch::receive(const plan_t& plan) {
  goal_lost_ = plan.goal_id == 0;
  plan_reason_ = plan.reason;
}

void EffectWatch::step(int64_t now, bool turns, const sim::RobotTruth& truth, bool active) {
  begun_ = begun_ || active;
  if (turns) turned_ = now;
  if (!since_ && active && now - turned_ < kTogether) {
    since_ = now;
    from_ = truth.distance;
    yaw_ = truth.T_map_body.yaw;
    effect_.moved = true;
  }
  if (since_ && active) effect_.lasted = seconds(now - *since_);
  if (!since_ || effect_.zero_after) return;
  if (named_ && !effect_.named_after) {
    effect_.named_after = seconds(now - *since_);
    effect_.named_way = truth.distance - from_;
  }
  if (!effect_.named_after)
    effect_.named_turn = std::max(effect_.named_turn, std::abs(truth.T_map_body.yaw - yaw_));
  const bool stopped = disarmed_ || goal_lost_ || now - turned_ > kForGood;
  if (now - turned_ < kStands || !stopped) return;
  effect_.zero_after = seconds(std::max(turned_ - *since_, int64_t{0}));
  effect_.zero_way = truth.distance - from_;
  effect_.reason = disarmed_ ? motor_reason_ : plan_reason_;
}

}  // namespace tread::faults
