// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "common/log/event_log.hpp"
#include "tests/bench/faults/fault_schedule.hpp"
#include "tools/lab/missions/robot_system.hpp"

namespace tread::faults {

/// The first rule that was broken.
struct Violation {
  int64_t utime = 0;  ///< [us]
  std::string what;
};

/// What came of the first fault, from where it began or, if that was later, from where the robot
/// moved.
struct FaultEffect {
  bool moved = false;                 ///< the robot moved while it lasted
  double lasted = 0.0;                ///< [s] from then on
  std::optional<double> named_after;  ///< [s] mapping told that a range finder is wrong
  std::optional<double> zero_after;   ///< [s] the motors were at zero, for half a second at least
  double named_way = 0.0;             ///< [m]
  double named_turn = 0.0;            ///< [rad]
  double zero_way = 0.0;              ///< [m] until it stood
  std::string reason;                 ///< MOTOR's or PLAN's then
};

/// What came of a mission.
struct FaultyRun {
  std::optional<Violation> violation;
  bool drove = false;        ///< the motors turned at all
  bool drove_after = false;  ///< and after the last fault
  bool arrived = false;      ///< the planner says so
  int collisions = 0;
  int64_t paths_judged = 0;
  double least_room = 0.0;  ///< [m] to a fence that it was held to; infinite if to none
  bool by_hand = false;     ///< a person drove it
  bool lied = false;        ///< a stick that lies had its button held, and the robot was armed
  bool returned = false;    ///< it moved without its operator
  bool tilt_stop = false;   ///< the bridge stopped it for its roll or pitch
  bool fence_stop = false;  ///< ... or at a fence
  FaultEffect effect;
};

struct RunOptions {
  double duration = 16.0;  ///< [s]
  int beams = 181;         ///< of a scan: most of a mission's cost is in casting them
  int64_t operator_lease_us = 1'000'000;  ///< that the rules count with
  double tilt = 30.0 / 180.0 * kPi;       ///< [rad] that the rules count with
  bool keeps_fences = true;               ///< false: nobody on the robot knows those of its file
  LogWriter* log = nullptr;               ///< records all messages
};

/// Drives a mission of this seed under its faults, and looks at the rules at each message and every
/// 5 ms; ends at the first that is broken.
FaultyRun runFaulty(const missions::RobotConfig& robot, const FaultSchedule& schedule,
                    const RunOptions& options = {});
/// A lying range finder alone, at a moment that the seed draws.
FaultSchedule scanScheduleOf(uint64_t seed, double duration);
/// The faults of a seed, in a mission of this duration [s], without fences, hands and returns.
FaultSchedule bareScheduleOf(uint64_t seed, double duration);
/// The same with them, and with faults of theirs.
FaultSchedule scheduleOf(uint64_t seed, double duration);
/// The same with a hand that lies in every mission.
FaultSchedule lyingScheduleOf(uint64_t seed, double duration);

}  // namespace tread::faults
