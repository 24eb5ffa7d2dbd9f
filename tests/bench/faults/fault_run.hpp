// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "common/log/event_log.hpp"
#include "tests/bench/faults/fault_schedule.hpp"
#include "tools/lab/missions/robot_system.hpp"

namespace tread::faults {

/// The first violation of a rule.
struct Violation {
  int64_t utime = 0;  ///< [us]
  std::string what;
};

/// Effect of the first fault, from its beginning or, if later, from the first motion.
struct FaultEffect {
  bool moved = false;                 ///< the robot moved during the fault
  double lasted = 0.0;                ///< [s] from then on
  std::optional<double> named_after;  ///< [s] until mapping reported the range finder
  /// [s] until the motors were at zero for at least half a second
  std::optional<double> zero_after;
  double named_way = 0.0;   ///< [m]
  double named_turn = 0.0;  ///< [rad]
  double zero_way = 0.0;    ///< [m] until standstill
  std::string reason;       ///< MOTOR's or PLAN's then
};

/// Result of a mission.
struct FaultyRun {
  std::optional<Violation> violation;
  bool drove = false;        ///< the motors turned
  bool drove_after = false;  ///< and after the last fault
  bool arrived = false;      ///< reported by the planner
  int collisions = 0;
  int64_t paths_judged = 0;
  double least_room = 0.0;  ///< [m] least distance to a fence that applied; infinite if none did
  bool by_hand = false;     ///< a person drove it
  bool lied = false;        ///< a lying stick had its button held while the robot was armed
  bool returned = false;    ///< it moved without its operator
  bool tilt_stop = false;   ///< the bridge stopped it because of roll or pitch
  bool fence_stop = false;  ///< ... or at a fence
  FaultEffect effect;
};

struct RunOptions {
  double duration = 16.0;                 ///< [s]
  int beams = 181;                        ///< per scan: casting beams is most of a mission's cost
  int64_t operator_lease_us = 1'000'000;  ///< used by the rules
  double tilt = 30.0 / 180.0 * kPi;       ///< [rad] used by the rules
  bool keeps_fences = true;               ///< false: no process has the fences of the robot's file
  LogWriter* log = nullptr;               ///< records all messages
};

/// Drives the mission of a seed with its faults, checks the rules at each message and every 5 ms,
/// and ends at the first violation.
FaultyRun runFaulty(const missions::RobotConfig& robot, const FaultSchedule& schedule,
                    const RunOptions& options = {});
/// Only a lying range finder, from a random time on.
FaultSchedule scanScheduleOf(uint64_t seed, double duration);
/// The faults of a seed, in a mission of this duration [s], without fences, manual control and
/// returns.
FaultSchedule bareScheduleOf(uint64_t seed, double duration);
/// The same with them, and with their faults.
FaultSchedule scheduleOf(uint64_t seed, double duration);
/// The same with a lying stick in every mission.
FaultSchedule lyingScheduleOf(uint64_t seed, double duration);

}  // namespace tread::faults
