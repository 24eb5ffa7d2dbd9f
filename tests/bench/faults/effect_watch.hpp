// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <tread/health_t.hpp>
#include <tread/motor_t.hpp>
#include <tread/plan_t.hpp>

#include "modules/simulator/core/robot.hpp"
#include "tests/bench/faults/fault_run.hpp"

namespace tread::faults {

/// Measures the effect of a fault until the robot stands for good: disarmed, without a goal, or for
/// three seconds.
class EffectWatch {
 public:
  void receive(const health_t& health);
  void receive(const motor_t& motor);
  void receive(const plan_t& plan);
  void step(int64_t now, bool turns, const sim::RobotTruth& truth, bool active);
  const FaultEffect& effect() const { return effect_; }

 private:
  std::string motor_reason_, plan_reason_;
  bool disarmed_ = false, goal_lost_ = false;
  bool begun_ = false;
  bool named_ = false;            ///< reported since the fault's beginning
  std::optional<int64_t> since_;  ///< [us] start of motion under the fault
  int64_t turned_ = 0;            ///< [us] last motion of the motors
  double from_ = 0.0, yaw_ = 0.0;
  FaultEffect effect_;
};

}  // namespace tread::faults
