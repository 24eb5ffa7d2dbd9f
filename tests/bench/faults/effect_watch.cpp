// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/effect_watch.hpp"

#include <algorithm>
#include <cmath>

namespace tread::faults {
namespace {

constexpr int64_t kStands = 500'000;  // [us] of zero: no pause between two patterns

double seconds(int64_t us) {
  return static_cast<double>(us) * 1e-6;
}

}  // namespace

void EffectWatch::receive(const health_t& health) {
  const bool failed = health.process == "mapping" && health.health_state == health_t::HEALTH_FAILED;
  named_ = named_ || failed;
}

void EffectWatch::receive(const motor_t& motor) {
  disarmed_ = motor.bridge_state == motor_t::STATE_DISARMED;
  motor_reason_ = motor.state_reason;
}

void EffectWatch::step(int64_t now, bool turns, const sim::RobotTruth& truth, bool active) {
  if (!since_ && active && turns) {
    since_ = turned_ = now;
    from_ = truth.distance;
    yaw_ = truth.T_map_body.yaw;
    effect_.moved = true;
  }
  if (!since_ || effect_.zero_after) return;
  effect_.named_turn = std::max(effect_.named_turn,
                                effect_.named_after ? 0.0 : std::abs(truth.T_map_body.yaw - yaw_));
  if (named_ && !effect_.named_after) {
    effect_.named_after = seconds(now - *since_);
    effect_.named_way = truth.distance - from_;
  }
  if (turns) turned_ = now;
  if (now - turned_ < kStands) return;
  effect_.zero_after = seconds(turned_ - *since_);
  effect_.zero_way = truth.distance - from_;
  effect_.reason = disarmed_ ? motor_reason_ : plan_reason_;
}

}  // namespace tread::faults
