// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/statistics/statistics.hpp"
#include "modules/commissioning/core/wiring_faults.hpp"
#include "modules/commissioning/core/wiring_fit.hpp"

namespace tread::commissioning {

/// The sides that move if one side is commanded forward.
struct SideMotion {
  Side side = Side::kLeft;
  bool forward = true;
};

/// Known properties of the vehicle before the drive; unknown values are only measured.
struct WiringExpectation {
  double gauge = 0.0;  ///< [m] effective; 0 = unknown
  /// What a person saw when only the configured left side was commanded forward. The INS alone
  /// cannot distinguish a vehicle from one with front and rear exchanged.
  std::optional<SideMotion> seen;
  bool brief = false;  ///< a few seconds: only large deviations count
  /// [m] of a car with throttle and steering commands instead of left and right: `seen.forward` is
  /// the direction of the throttle, `seen.side` that of the steering. 0 = two sides.
  double wheelbase = 0.0;
};

/// Results of the drive.
struct WiringReport {
  std::string unsure;  ///< why there is no result, one line; empty = the rest is valid
  /// The sides that the configured left and right side really move.
  std::array<SideMotion, 2> moves{SideMotion{Side::kLeft, true}, SideMotion{Side::kRight, true}};
  std::array<bool, 2> dead{false, false};  ///< configured left and right side
  ConfidenceInterval full_left;   ///< [m/s] of the real left track at full command, on this ground
  ConfidenceInterval full_right;  ///< [m/s]
  ConfidenceInterval gauge;       ///< [m] effective: track speed difference over yaw rate
  ConfidenceInterval mounting_yaw;  ///< [rad] correction of the configured one
  ConfidenceInterval antenna_x;  ///< [m] in body, of the INS's point relative to the configured one
  ConfidenceInterval antenna_y;  ///< [m]
  ConfidenceInterval delay;      ///< [s] from a command to its effect in the INS
  ConfidenceInterval lag;        ///< [s]
  ConfidenceInterval dead_power;         ///< [1]
  ConfidenceInterval steering_left;      ///< [rad] of a car at full steering to the left
  ConfidenceInterval steering_right;     ///< [rad] the same to the right, negative
  ConfidenceInterval steering_straight;  ///< [rad] at zero command
  ConfidenceInterval steering_lag;       ///< [s]
  WiringFit fit;
  std::vector<WiringFault> faults;

  bool has(FaultKind kind, std::optional<Side> side = std::nullopt) const;
  /// [m/s] of the slower side at full command.
  double fullSpeed() const;
};

/// Compares the INS's measurements with the commands: connections, directions and speeds of the
/// sides, mounting of the INS.
/** 1. Commands pass delay, dead power and lag; the INS's velocity and yaw rate are linear in the
 *    result (WiringFit).
 * 2. Forward is the direction in which both sides move the vehicle without turning, or in which the
 *    rear axle of a car moves. A point elsewhere also moves by turning, which yields its position.
 *    The direction and strength of a car's turn, with the wheelbase, give the wheel angle.
 * 3. Ahead or astern: both explain the same motions, with other parts swapped or reversed. `seen`
 *    decides, else the explanation with fewer faulty parts, else the smaller rotation of the INS.
 * 4. A yaw of the wrong sign does not fit the path.
 * 5. Intervals come from leaving out a twelfth of the drive at a time (jackknife).
 * The drive must contain straight motion, turns and each side alone, in both directions. */
WiringReport checkWiring(const std::vector<TimedCommand>& commands,
                         const std::vector<TimedPose>& fixes, const WiringExpectation& expected);

}  // namespace tread::commissioning
