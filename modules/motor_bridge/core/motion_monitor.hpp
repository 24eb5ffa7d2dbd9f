// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "common/execution/stop_reason.hpp"
#include "modules/motor_bridge/core/motion_response.hpp"
#include "modules/motor_bridge/core/motion_track.hpp"
#include "modules/motor_bridge/core/motor_controller.hpp"

namespace tread::motor {

/// Compares commanded with measured motion, and what the INS says of one motion in two ways.
/** For each measurement:
    1. MotionTrack sums up what was measured and what the commands explain, slip included;
    2. one step, and windows of 1 and 3 s, are checked: pose against the INS's own rate and
       velocity, travel, turn and sideways motion against the commands;
    3. MotionResponse compares windows of 0.7 s with what the robot lately made of its commands
       (of two tracks: a holonomic base's wheels have no such names yet);
    4. what fails is named by what the motors tell beside it.
    It knows no pattern: any series of commands will do, driven by whomever. A drift slower than
    slip cannot be told from slip by commands: only the INS's own velocity shows it. */
class MotionMonitor {
 public:
  explicit MotionMonitor(const MotionLimits& limits)
      : track_(limits),
        response_(limits),
        wheel_stands_since_(limits.isOmni() ? limits.wheels.size() : 2, 0) {}

  /// What MotionLimits::motion() makes of the command that holds from now [us] on.
  void command(const Command& motion, int64_t now) { track_.command(motion, now); }
  /// What the controller tells of the motors.
  void receive(const MotorTelemetry& motors) { motors_ = motors; }
  /// A measurement; one that is not newer than the last, or has no pose, is passed over.
  void receive(const InsMotion& ins);

  /// What the commands cannot explain at now [us], in one line; none = nothing.
  /** A verdict stands a little longer than its windows need to fill again: what goes on is told
   * without a break. */
  Reason fault(int64_t now) const;

 private:
  void watchTracks(int64_t utime);
  Reason standingTrack(int64_t utime) const;
  Reason standingWheel(int64_t utime) const;
  Reason surelyWrong() const;
  Reason suspicion() const;
  /// From what the robot lately made of its commands.
  Reason departure() const;
  void learn();
  void tell(const Reason& verdict, int64_t utime);

  MotionTrack track_;
  MotionResponse response_;
  MotorTelemetry motors_;
  double doubts_ = 0.0;        ///< [1] unreachable poses lately
  double position_std_ = 0.0;  ///< [m] of the last measurements
  std::vector<int64_t>
      wheel_stands_since_;        ///< [us] left, right, or each wheel: against its command
  int64_t suspected_since_ = -1;  ///< [us] measurements since then are suspicious; -1 = none
  Reason verdict_;
  int64_t told_ = 0;  ///< [us] time of the measurement that the verdict was given on
};

}  // namespace tread::motor
