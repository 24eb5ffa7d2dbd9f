// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "common/execution/operator_lease.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/omni_wheels.hpp"

namespace tread::motor {

/// What a person may do by hand.
struct ManualLimits {
  int64_t lease_us = 200'000;  ///< [us] for which it counts what the person's program has seen
  double max_command = 0.5;    ///< largest magnitude, in the units of the drive
  double slew = 1.0;           ///< largest growth of a command [units of the drive per s]
  double max_steering = 0.0;   ///< [rad] of a car; 0 = two tracks
  OmniWheels wheels;           ///< of a holonomic base; else none
  double gauge = 1.0;          ///< [m] of a holonomic base: the tracks that its stick stands for
};

/// The robot's command for a stick that is told as tracks, in the units of the drive.
/** A car drives by their mean and steers by their difference: max_steering where one track has
 * max_command and the other one has it backward. A holonomic base moves as two tracks would; where
 * a wheel would need more than max_command, all of them do less. */
Command commandOf(const TrackCommand& stick, const ManualLimits& limits);

/// One MANUAL message of the operator who holds the robot.
struct ManualNotice {
  int64_t station = 0;     ///< one start of a program
  std::string name;        ///< who
  int64_t seq = 0;         ///< counts up within a station
  int64_t seen_utime = 0;  ///< [us] of the newest MOTOR that the program has heard
  bool hold = false;       ///< the dead-man's button is pressed
  bool give_back = false;
  /// [1] share of the largest command, -1..1, + forward; NaN: the stick's place is not known.
  double left = std::numeric_limits<double>::quiet_NaN();
  double right = std::numeric_limits<double>::quiet_NaN();
};

/// What a person at the stick wants of the robot, and what the motors are given of it.
/** A moved stick takes the robot over, with the dead-man's button held. Without the button, and a
 * lease after the newest that was seen, the command is zero at once; the robot stays in the hand
 * until it is given back. At first, after such a silence, when its place was not known and when the
 * robot is armed, the stick must be seen at rest before it moves anything: in one message that
 * tells both tracks. A released button is no rest. Pure: time is an argument. */
class ManualControl {
 public:
  explicit ManualControl(const ManualLimits& limits) : limits_(limits), lease_(limits.lease_us) {}

  /// A message received at now [us]. Returns why it counts for nothing; empty = it was taken.
  std::string receive(const ManualNotice& notice, int64_t now);
  /// A program has let go. Returns whether it was this hand's.
  bool letGo(int64_t station);
  /// Call first in each step. `has`: the robot is in the hand since the step before; `armed`: it is
  /// armed.
  void update(int64_t now, bool has, bool armed);

  /// A robot that is armed is to be taken over.
  bool takes() const { return live_ && !must_rest_ && !atRest(); }
  /// A robot that is not armed is to be armed for the hand: the button is held, the stick rests.
  bool ready() const { return live_ && atRest(); }
  bool givenBack() const { return last_.give_back; }
  /// Why a held button moves nothing; empty = nothing is in the way, or it is not held.
  std::string bar() const;
  /// In whose hand, and why it stands, if it does.
  std::string words() const;
  /// Command of now [us]; call it once in each step while the robot is in the hand.
  TrackCommand command(int64_t now);

 private:
  static constexpr int64_t kInterval = 20'000;  ///< [us] a command is held

  /// [1] of the largest command: a worn spring's rest, which moves nothing.
  static constexpr double kRest = 0.05;

  /// False where it is not known.
  bool atRest() const { return std::abs(last_.left) <= kRest && std::abs(last_.right) <= kRest; }

  ManualLimits limits_;
  OperatorLease lease_;  ///< its holder is a station: one hand at a time
  ManualNotice last_;
  bool fresh_ = false;     ///< what was seen last is younger than the lease
  bool live_ = false;      ///< fresh, with the button held, and not given back
  bool must_rest_ = true;  ///< the stick moves nothing until it is seen at rest
  TrackCommand command_;
  std::optional<int64_t> commanded_;  ///< [us] when the command was last changed
};

}  // namespace tread::motor
