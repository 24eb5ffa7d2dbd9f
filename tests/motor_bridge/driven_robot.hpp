// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>

#include <tread/ins_t.hpp>

#include "common/geometry/se2.hpp"
#include "tests/motor_bridge/messages.hpp"

namespace tread::motor {

/// A robot driven by two motors, and its INS: tracks with a lag of 0.1 s, half of a turn lost to
/// slip.
class DrivenRobot {
 public:
  /// Faults of the INS.
  bool frozen = false;    ///< repeats its last measurement with new times
  Pose2 offset;           ///< added to the measured pose, in map
  double yaw_sign = 1.0;  ///< -1: turns have the wrong sign
  double roll = 0.0;      ///< [rad] of the ground
  bool attitude = true;   ///< roll and pitch are measured
  double grip = 1.0;      ///< [1] share of the tracks' travel that becomes motion

  /// Sets powers [1/1000] up to utime [us].
  void follow(int left, int right, int64_t utime) {
    const double dt = utime_ == 0 ? 0.0 : 1e-6 * static_cast<double>(utime - utime_);
    utime_ = utime;
    const double share = 1.0 - std::exp(-dt / 0.1);
    left_ += share * (kFullSpeed * left / 1000.0 - left_);
    right_ += share * (kFullSpeed * right / 1000.0 - right_);
    v_ = 0.5 * grip * (left_ + right_);
    omega_ = 0.5 * grip * (right_ - left_) / kGauge;
    truth_ = truth_ * Pose2{v_ * dt, 0.0, omega_ * dt};
  }
  const Pose2& truth() const { return truth_; }

  ins_t measured(int64_t utime, int64_t seq) {
    if (!frozen) {
      last_ = makeIns(utime, seq);
      const double yaw = yaw_sign * truth_.yaw + offset.yaw;
      last_.position[0] = truth_.x + offset.x;
      last_.position[1] = truth_.y + offset.y;
      last_.orientation[0] = std::cos(0.5 * yaw) * std::cos(0.5 * roll);
      last_.orientation[1] = std::cos(0.5 * yaw) * std::sin(0.5 * roll);
      last_.orientation[2] = std::sin(0.5 * yaw) * std::sin(0.5 * roll);
      last_.orientation[3] = std::sin(0.5 * yaw) * std::cos(0.5 * roll);
      if (!attitude) last_.ins_status |= ins_t::STATUS_NO_ATTITUDE;
      last_.velocity[0] = v_;
      last_.rate[2] = yaw_sign * omega_;
    }
    last_.utime = utime;
    last_.seq = seq;
    return last_;
  }

 private:
  static constexpr double kGauge = 0.6;
  static constexpr double kFullSpeed = 1.1;

  int64_t utime_ = 0;
  double left_ = 0.0, right_ = 0.0;  ///< [m/s]
  double v_ = 0.0, omega_ = 0.0;
  Pose2 truth_;
  ins_t last_{};
};

}  // namespace tread::motor
