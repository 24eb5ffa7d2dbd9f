// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tools/robot/setup/core/wiring_fit.hpp"

namespace tread::setup {

enum class Side { kLeft, kRight };

constexpr const char* nameOf(Side side) {
  return side == Side::kLeft ? "left" : "right";
}
constexpr Side otherOf(Side side) {
  return side == Side::kLeft ? Side::kRight : Side::kLeft;
}

/// A measured quantity and the limits between which it is with 95 %.
struct Interval {
  double value = 0.0;
  double low = 0.0;
  double high = 0.0;

  bool holds(double truth) const { return low <= truth && truth <= high; }
};

/// What moves when one side is commanded forward.
struct SideMotion {
  Side side = Side::kLeft;
  bool forward = true;
};

/// What is told of the vehicle before the drive; what is not told is only measured.
struct WiringExpectation {
  double gauge = 0.0;  ///< [m] effective; 0 = not told
  /// What a person saw when only the configured left side was commanded forward. The INS alone
  /// cannot tell a vehicle from the same one with front and rear exchanged.
  std::optional<SideMotion> seen;
  bool brief = false;  ///< a few seconds: only large deviations count
  /// [m] between the axles of a car, whose commands are throttle and steering instead of left and
  /// right: then `seen.forward` is where throttle drives, `seen.side` where steering turns. 0 = two
  /// sides.
  double wheelbase = 0.0;
};

enum class FaultKind {
  kNoMotion,
  kSwapped,
  kReversed,
  kDead,
  kWeak,
  kInsTurned,
  kInsMirrored,
  kInsElsewhere,
  kGauge,
  kSteeringReversed,
  kSteeringDead,
  kSteeringAskew
};

/// Something that is not as it is configured.
struct WiringFault {
  FaultKind kind = FaultKind::kNoMotion;
  std::optional<Side> side;  ///< that it concerns; of a side's faults only
  double amount = 0.0;       ///< weak: share of the other side; turned [rad]; elsewhere, gauge [m]
  std::string words;         ///< what, how much, what to do; one line
};

/// What the drive has shown.
struct WiringReport {
  std::string unsure;  ///< why nothing can be said, one line; empty = the rest holds
  /// What the configured left and right side really move.
  std::array<SideMotion, 2> moves{SideMotion{Side::kLeft, true}, SideMotion{Side::kRight, true}};
  std::array<bool, 2> dead{false, false};  ///< configured left and right side
  Interval full_left;          ///< [m/s] of the real left track at full command, on this ground
  Interval full_right;         ///< [m/s]
  Interval gauge;              ///< [m] effective: track speed difference over yaw rate
  Interval mounting_yaw;       ///< [rad] to be added to the configured one
  Interval antenna_x;          ///< [m] in body, of the INS's point beside the configured one
  Interval antenna_y;          ///< [m]
  Interval delay;              ///< [s] from a command to its effect in the INS
  Interval lag;                ///< [s]
  Interval dead_power;         ///< [1]
  Interval steering_left;      ///< [rad] of a car at full steering to the left
  Interval steering_right;     ///< [rad] the same to the right, negative
  Interval steering_straight;  ///< [rad] at none
  Interval steering_lag;       ///< [s]
  WiringFit fit;
  std::vector<WiringFault> faults;

  bool has(FaultKind kind, std::optional<Side> side = std::nullopt) const;
  /// [m/s] of the slower side at full command.
  double fullSpeed() const;
};

/// Compares what the INS saw with what was commanded: what hangs where, which way round, how fast.
/** 1. Commands pass delay, dead power and lag; the INS's velocity and yaw rate are linear in them.
 *  2. Forward is the direction of the motion that both sides make without turning; a point beside
 *     the middle moves by turning, too, and so is found. Whether this is ahead or astern is told by
 *     `seen`, else by the smaller turn of the INS.
 *  3. A yaw that goes the wrong way round does not fit the path.
 *  4. Intervals come from leaving out a twelfth of the drive at a time.
 * Wants the vehicle driven straight, turning and with each side alone, to and fro. */
WiringReport checkWiring(const std::vector<GivenCommand>& commands,
                         const std::vector<InsFix>& fixes, const WiringExpectation& expected);

}  // namespace tread::setup
