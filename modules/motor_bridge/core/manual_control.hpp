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

/// Limits of manual control.
struct ManualLimits {
  int64_t lease_us = 200'000;  ///< [us] for which a sighting by the person's program counts
  double max_command = 0.5;    ///< largest magnitude, in the units of the drive
  double slew = 1.0;           ///< largest growth of a command [units of the drive per s]
  double max_steering = 0.0;   ///< [rad] of a car; 0 = two tracks
  OmniWheels wheels;           ///< of a holonomic base; otherwise empty
  double gauge = 1.0;  ///< [m] of a holonomic base: gauge of the tracks that the stick emulates
};

/// The robot's command for a stick position, given as track commands in the units of the drive.
/** For a car their mean gives the speed and their difference the steering: max_steering for one
 * track at max_command and the other at its negative. A holonomic base moves as two tracks would;
 * if a wheel would need more than max_command, all are reduced in proportion. */
Command commandOf(const TrackCommand& stick, const ManualLimits& limits);

/// A MANUAL message of the operator who holds the robot.
struct ManualNotice {
  int64_t station = 0;     ///< one start of a program
  std::string name;        ///< who
  int64_t seq = 0;         ///< increases within a station
  int64_t seen_utime = 0;  ///< [us] of the newest MOTOR that the program has received
  bool hold = false;       ///< the dead-man's button is pressed
  bool give_back = false;
  /// [1] share of the largest command, -1..1, + forward; NaN: stick position unknown.
  double left = std::numeric_limits<double>::quiet_NaN();
  double right = std::numeric_limits<double>::quiet_NaN();
};

/// Manual control: requests of the person at the stick, and the resulting commands.
/** Moving the stick with the dead-man's button held takes control of the robot. Releasing the
 * button, or a lease expiring since the newest sighting, gives zero at once; the robot stays under
 * manual control until it is handed back. Initially, after such a silence, after an unknown stick
 * position and after arming, the stick must be seen at rest before it moves anything: in one
 * message with both tracks. A released button does not count as rest. Pure: time is an argument. */
class ManualControl {
 public:
  explicit ManualControl(const ManualLimits& limits) : limits_(limits), lease_(limits.lease_us) {}

  /// A message received at now [us]. Returns why it does not count; empty = accepted.
  std::string receive(const ManualNotice& notice, int64_t now);
  /// A program has released control. Returns whether it had control.
  bool letGo(int64_t station);
  /// Call first in each step. `has`: under manual control since the previous step; `armed`: the
  /// robot is armed.
  void update(int64_t now, bool has, bool armed);

  /// Take control of an armed robot.
  bool takes() const { return live_ && !must_rest_ && !atRest(); }
  /// Arm the robot for manual control: the button is held, the stick is at rest.
  bool ready() const { return live_ && atRest(); }
  bool givenBack() const { return last_.give_back; }
  /// Why a held button moves nothing; empty = nothing prevents it, or it is not held.
  std::string bar() const;
  /// Who has control, and why the robot stands, if it does.
  std::string words() const;
  /// Command of now [us]; call it once per step under manual control.
  TrackCommand command(int64_t now);

 private:
  static constexpr int64_t kInterval = 20'000;  ///< [us] for which a command is held

  /// [1] of the largest command: rest position of a worn spring, which moves nothing.
  static constexpr double kRest = 0.05;

  /// False if the position is unknown.
  bool atRest() const { return std::abs(last_.left) <= kRest && std::abs(last_.right) <= kRest; }

  ManualLimits limits_;
  OperatorLease lease_;  ///< its holder is a station: only one has control at a time
  ManualNotice last_;
  bool fresh_ = false;     ///< the newest sighting is younger than the lease
  bool live_ = false;      ///< fresh, with the button held, and not handed back
  bool must_rest_ = true;  ///< the stick has no effect until it is seen at rest
  TrackCommand command_;
  std::optional<int64_t> commanded_;  ///< [us] of the last change of the command
};

}  // namespace tread::motor
