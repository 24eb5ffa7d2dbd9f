// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/bus/channels.hpp"
#include "tools/replay/robot_log.hpp"

namespace tread::replay {

/// How many messages of one type the log and the replay share.
struct MessageCounts {
  int64_t equal = 0;
  int64_t different = 0;
  int64_t only_in_log = 0;
  int64_t only_in_replay = 0;  ///< the recorder lost them, or stopped before they came
};

/// The comparison of a process's messages in a robot's log with those of its replay.
struct ReplayCheck {
  std::string name;
  int lives = 0;                 ///< starts of the process in the log
  std::string first_difference;  ///< in words; empty = none
  bool same_twice = true;        ///< a second replay published the same bytes
  std::vector<std::string> notes;

  void noteDifference(const std::string& difference) {
    if (first_difference.empty()) first_difference = difference;
  }
  /// Notes what `process` counted itself, what the log lacks, and whether it is damaged.
  void noteLog(const RobotLog& log, const std::string& process);
};

bool sameBytes(const std::vector<LogEvent>& a, const std::vector<LogEvent>& b);

/// "2 equal, 0 different, ..." with `unit` ("versions ") before "equal".
std::string countsText(const MessageCounts& counts, const std::string& unit);
/// The lines of a report between its head and its counts.
std::string notesText(const ReplayCheck& check);
/// "  first difference: ..." or nothing.
std::string differenceText(const ReplayCheck& check);

/// Compares messages by key. `difference(log, replay)` is empty for equal messages; `name(key)` is
/// for the report. Only-in-replay messages whose key is in `late`, or no more than the log is known
/// to lack (`lost`), are no difference.
template <class Key, class Message, class Difference, class Name>
MessageCounts compareByKey(const std::map<Key, Message>& log, const std::map<Key, Message>& replay,
                           const std::set<Key>& late, int64_t lost, Difference difference,
                           Name name, ReplayCheck& check) {
  MessageCounts counts;
  for (const auto& [key, message] : log) {
    const auto found = replay.find(key);
    if (found == replay.end()) {
      ++counts.only_in_log;
      check.noteDifference(name(key) + ": in the log, not in the replay");
      continue;
    }
    const std::string differs = difference(message, found->second);
    ++(differs.empty() ? counts.equal : counts.different);
    if (!differs.empty()) check.noteDifference(differs);
  }
  std::vector<Key> unexplained;
  for (const auto& [key, message] : replay) {
    if (log.count(key) > 0) continue;
    ++counts.only_in_replay;
    if (late.count(key) == 0) unexplained.push_back(key);
  }
  if (static_cast<int64_t>(unexplained.size()) > lost)
    check.noteDifference(name(unexplained.front()) + ": in the replay, not in the log");
  return counts;
}

/// The first field in which a message of the log and one of the replay differ, in words, with both
/// values; empty if they are equal. `seq` is never compared.
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

/// The channels to play to a process: what it hears, without what it publishes itself and without
/// what every process publishes, so that it never hears its own past.
std::vector<std::string> playedChannels(const std::string& process);

/// Expression for `lcm-logplayer -e`, anchored: LCM would find INS in INSIDE, too.
std::string channelFilter(const std::string& process);

/// The commands to type, with a line on each: the process, and lcm-logplayer with its filter.
std::string recipeFor(const std::string& process, const std::string& log);

}  // namespace tread::replay
