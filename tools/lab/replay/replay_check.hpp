// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/drive/robot_log.hpp"
#include "common/log/event_log.hpp"

namespace tread::replay {

/// Numbers of equal and different messages of one type in log and replay.
struct MessageCounts {
  int64_t equal = 0;
  int64_t different = 0;
  int64_t only_in_log = 0;
  int64_t only_in_replay = 0;  ///< lost by the recorder, or published after it stopped
};

/// Comparison of a process's messages in a robot's log with those of its replay.
struct ReplayCheck {
  std::string name;
  int lives = 0;                 ///< starts of the process in the log
  std::string first_difference;  ///< in words; empty = none
  bool same_twice = true;        ///< a second replay published identical bytes
  std::vector<std::string> notes;

  void noteDifference(const std::string& difference) {
    if (first_difference.empty()) first_difference = difference;
  }
  /// Stores the counts of `process` itself, gaps of the log, and its damage.
  void noteLog(const RobotLog& log, const std::string& process);
};

bool sameBytes(const std::vector<LogEvent>& a, const std::vector<LogEvent>& b);

/// "2 equal, 0 different, ..." with `unit` ("versions ") before "equal".
std::string countsText(const MessageCounts& counts, const std::string& unit);
/// Lines of a report between heading and counts.
std::string notesText(const ReplayCheck& check);
/// "  first difference: ...", or empty.
std::string differenceText(const ReplayCheck& check);

/// The first field in which two messages differ, with both values; empty if they are equal. `seq`
/// is not compared.
/** `tolerance` of numbers [m, rad, m2 ...]; 0 = to the bit, and only then checksums are compared.
 */
std::string differenceOf(const pattern_set_part_t& log, const pattern_set_part_t& replay,
                         double tolerance);
std::string differenceOf(const learning_t& log, const learning_t& replay, double tolerance);
/// To the bit; what the planner had received is not compared.
std::string differenceOf(const program_t& log, const program_t& replay);
/// To the bit; `search_time` is not compared.
std::string differenceOf(const plan_t& log, const plan_t& replay);

/// The processes that run from a played log: those without a device.
std::vector<std::string> playableProcesses();

/// The channels to play to a process: its inputs, without the channels that it or every process
/// publishes, as it must not receive its own old messages.
std::vector<std::string> playedChannels(const std::string& process);

/// Expression for `lcm-logplayer -e`, anchored: LCM would find INS in INSIDE, too.
std::string channelFilter(const std::string& process);

/// The commands to type, with a line on each: the process, and lcm-logplayer with its filter.
std::string recipeFor(const std::string& process, const std::string& log);

}  // namespace tread::replay
