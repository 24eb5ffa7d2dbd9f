// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/log/drive_log.hpp"

namespace tread::replay {

/// An event and the time at which a process of the robot received it.
struct TimedEvent {
  LogEvent event;
  int64_t heard = 0;  ///< [us] of the robot's clock, as utime; never decreases
};

/// The log of a running robot: what lcm-logger or tread-missions --log wrote.
/** A recorder dates events with its own clock, which for lcm-logger is UTC. The robot's time is
 * found as its processes find it: the newest utime heard plus the time passed since (LcmBus). In
 * virtual time (HEALTH without UTC) both clocks are one. */
struct RobotLog {
  std::string name;  ///< file name without folder
  std::vector<TimedEvent> events;
  std::map<std::string, std::string> configs;  ///< by process: the first CONFIG
  bool virtual_time = false;
  std::string problem;  ///< one clear line if the log is damaged; what is whole was read
  /// Messages that the log misses by seq, per channel.
  std::map<std::string, int64_t> missing;
};

/// Messages that a process counted (HEALTH) and those in the log, between its first and its last
/// HEALTH, summed over its starts.
struct Intake {
  int64_t heard = 0;  ///< messages that it received
  int64_t lost = 0;   ///< gaps in seq
  int64_t in_log = 0;
};
Intake intakeOf(const RobotLog& log, const std::string& process,
                const std::vector<std::string>& channels);
/// The counts in one line.
std::string intakeLine(const RobotLog& log, const std::string& process,
                       const std::vector<std::string>& channels);

/// Reads a log. Throws std::runtime_error with one clear line if it cannot be read or holds nothing
/// of ours.
RobotLog readRobotLog(const std::string& path);

/// The same from events in memory; `name` stands for the log in reports.
RobotLog toRobotLog(const std::string& name, std::vector<LogEvent> events);

}  // namespace tread::replay
