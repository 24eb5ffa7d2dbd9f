// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/drive/drive_timeline.hpp"

namespace tread {

/// The log of a running robot: what lcm-logger or tread-missions --log wrote.
struct RobotLog {
  std::string name;  ///< file name without folder
  /// At the times when a process of the robot received them [us], which never decrease.
  std::vector<LogEvent> events;
  std::map<std::string, std::string> configs;                 ///< by process: the first CONFIG
  std::map<std::string, std::vector<Said<health_t>>> health;  ///< by process
  bool virtual_time = false;                                  ///< if HEALTH has no UTC
  std::string problem;  ///< the log's problems in one line, see DriveReader
  /// Messages missing from the log by seq, per channel.
  std::map<std::string, int64_t> missing;

  /// HEALTH of a process; empty if it sent none.
  const std::vector<Said<health_t>>& healthOf(const std::string& process) const;
};

/// Messages that a process counted (HEALTH) and messages in the log, between its first and its last
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

/// Reads a log (one file, or its parts in order) without some channels, by default those that no
/// replayed process reads. Throws std::runtime_error with one clear line if it cannot be read or
/// holds none of Tread's messages.
RobotLog readRobotLog(const std::vector<std::string>& paths,
                      const std::vector<const char*>& without = {kScan.name, kPlanTree.name});

/// The same from events in memory, at the recorder's times; `name` stands for the log in reports.
RobotLog toRobotLog(const std::string& name, std::vector<LogEvent> events);

/// The CONFIG of a process with some values replaced, KEY=VALUE with dots between sections; throws
/// std::runtime_error with one clear line for an unknown key (CONFIG holds all keys).
ConfigReader loggedConfig(const RobotLog& log, const std::string& process,
                          const std::vector<std::string>& overrides);

}  // namespace tread
