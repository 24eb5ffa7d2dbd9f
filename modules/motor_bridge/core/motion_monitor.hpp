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

/// Compares the measured motion with the commands, and the INS's redundant measurements with each
/// other.
/** For each measurement:
 *   1. MotionTrack sums the measured motion and the motion that the commands explain, slip
 *      included;
 *   2. one step, and windows of 1 and 3 s, are checked: pose against the INS's own rate and
 *      velocity; travel, turn and sideways motion against the commands;
 *   3. MotionResponse compares windows of 0.7 s with the robot's recent response to its commands
 *      (for two tracks only: a holonomic base's wheels have no such names yet);
 *   4. failed checks are named with the help of motor data.
 * It is independent of patterns: any source of commands will do. A drift slower than slip cannot
 * be distinguished from slip by commands: only the INS's own velocity reveals it. */
class MotionMonitor {
 public:
  explicit MotionMonitor(const MotionLimits& limits)
      : track_(limits),
        response_(limits),
        wheel_stands_since_(limits.isOmni() ? limits.wheels.size() : 2, 0) {}

  /// Result of MotionLimits::motion() for the command that acts from now [us] on.
  void command(const Command& motion, int64_t now) { track_.command(motion, now); }
  /// The controller's motor data.
  void receive(const MotorTelemetry& motors) { motors_ = motors; }
  /// A measurement; ignored if it is not newer than the last or has no pose.
  void receive(const InsMotion& ins);

  /// What the commands cannot explain at now [us], in one line; no reason = nothing.
  /** A fault stays a little longer than its windows need to refill, so that a persistent one is
   * reported without interruption. */
  Reason fault(int64_t now) const;

 private:
  void watchTracks(int64_t utime);
  Reason standingTrack(int64_t utime) const;
  Reason standingWheel(int64_t utime) const;
  Reason surelyWrong() const;
  Reason suspicion() const;
  /// Fault relative to the robot's recent response to its commands.
  Reason departure() const;
  void learn();
  void tell(const Reason& verdict, int64_t utime);

  MotionTrack track_;
  MotionResponse response_;
  MotorTelemetry motors_;
  double doubts_ = 0.0;                      ///< [1] recent unreachable poses
  double position_std_ = 0.0;                ///< [m] of recent measurements
  std::vector<int64_t> wheel_stands_since_;  ///< [us] left, right, or each wheel: since when it
                                             ///< stands against its command
  int64_t suspected_since_ =
      -1;  ///< [us] since when measurements are suspicious; -1 = they are not
  Reason verdict_;
  int64_t told_ = 0;  ///< [us] time of the measurement behind the fault
};

}  // namespace tread::motor
