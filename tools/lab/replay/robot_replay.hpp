// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/bus/channels.hpp"
#include "common/drive/robot_log.hpp"
#include "modules/learner/core/learner.hpp"
#include "modules/learner/learner_node.hpp"
#include "modules/planner/planner_node.hpp"

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

/// Compares messages by key. `difference(log, replay)` is empty for equal messages; `name(key)` is
/// for the report. Messages only in the replay do not count as differences if their key is in
/// `late`, or up to the number that the log is known to lack (`lost`).
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

/// A robot's log through the learner.
/** In each of its lives the learner begins with the life's first LEARNER_STATE and receives INS,
 * MOTOR and EXECUTION. Compared: PATTERN_SET part by part and version by version, LEARNING per
 * execution; to the bit where the log holds the learner's start. */
struct LearnerCheck : ReplayCheck {
  bool from_start = true;  ///< the log contains the start of the first life
  double tolerance = 0.0;  ///< for numbers; 0 = bitwise
  int64_t first_version = 0;
  int64_t last_version = 0;
  MessageCounts versions;  ///< of PATTERN_SET
  MessageCounts learning;  ///< LEARNING, by execution
  int64_t measured = 0;    ///< executions that the replay measured; the others were refused

  /// Whether both replays published the messages of the log. They may publish more: as many as the
  /// log lacks by seq, and those after the learner's last message in the log.
  bool equal() const;
};

/// Replays the log twice and compares. Throws std::runtime_error with one clear line if the log has
/// no initial state of the learner.
LearnerCheck checkLearner(const RobotLog& log, const learner::LearnerNodeConfig& config);

/// A few lines of text.
std::string reportOf(const LearnerCheck& check);

/// One life of the learner in a log: from a start of the process to the next.
struct LearnerLife {
  size_t first_event = 0;  ///< index in the log
  size_t end_event = 0;    ///< one past the last
  int64_t boot_id = 0;
  bool from_start = false;          ///< the log contains its start
  learner::LearnerState state;      ///< the first one in the log
  std::vector<PatternSet> earlier;  ///< earlier versions that executions may still name
};

/// The lives in a log, in order. Throws std::runtime_error with one clear line if the log has no
/// complete state, or states of another shipped set.
std::vector<LearnerLife> learnerLives(const RobotLog& log, const PatternSet& shipped);

/// A robot's log through the planner.
/** The planner steps at the times of the log's planner (utime of PROGRAM), with the messages
 * received by then (newest_input, inputs_heard). Searches end by a count of expansions: the
 * configured one, or that of the log's PLAN where the deadline cut the search on the robot.
 * Compared per step, to the bit: PROGRAM and PLAN without seq and search_time. */
struct PlannerCheck : ReplayCheck {
  int compared = 0;  ///< lives that begin in the log; the others cannot be compared
  int64_t steps = 0;
  int64_t searches_cut = 0;  ///< by the robot's deadline
  MessageCounts programs;
  MessageCounts plans;
  int64_t plans_lost = 0;  ///< PLANs missing in the log, by seq
  int64_t lacking = 0;     ///< messages that the planners had received and the log lacks

  /// Whether both replays published the messages of the log. PLANs only in the replay may be as
  /// many as the recorder lost by seq. If nothing was compared the result is false.
  bool equal() const {
    return same_twice && programs.equal > 0 && programs.different == 0 && plans.different == 0 &&
           plans.only_in_log == 0 && plans.only_in_replay <= plans_lost;
  }
};

/// The planner's configuration from the log's CONFIG. Throws std::runtime_error with one clear
/// line.
planner::PlannerConfig plannerConfigOf(const RobotLog& log,
                                       const std::vector<std::string>& overrides = {});

/// Replays the log twice and compares. Throws std::runtime_error with one clear line if the log has
/// no PROGRAM.
PlannerCheck checkPlanner(const RobotLog& log, const planner::PlannerConfig& config);

/// A few lines of text.
std::string reportOf(const PlannerCheck& check);

/// A message to the planner: its place in the log, and its channel, utime and seq.
struct PlannerInput {
  size_t event = 0;
  Receipt receipt;
};

/// The decodable messages on the planner's channels, in the order of the log.
std::vector<PlannerInput> plannerInputs(const RobotLog& log, const planner::PlannerConfig& config);

/// A step of the planner in the log.
struct LoggedStep {
  program_t program;
  bool lost = false;  ///< the log lacks its PROGRAM: only an approximate `utime` is known
};

/// The messages in the log that a planner had received before each of its steps.
struct Hearing {
  std::vector<PlannerInput> inputs;  ///< in the order of reception
  size_t from = 0;                   ///< the first one received
  std::vector<size_t> until;         ///< by step: the first one not yet received
  int64_t by_time = 0;               ///< steps without a known newest message: assigned by time
  int64_t reordered = 0;  ///< pairs of messages that the recorder received in the opposite order
  int64_t lacking = 0;    ///< messages received by the planner but missing in the log
  int64_t beyond = 0;     ///< messages in the log that the planner did not receive
};

/// Finds the newest message that each PROGRAM names (newest_input, its utime and seq) in the log.
/** Processes on one host receive messages in the same order, except for pairs that arrive within
 * microseconds: inputs_heard reveals those. It also shows where a planner began to receive, and
 * messages that planner or recorder lost. */
Hearing hearingOf(const RobotLog& log, std::vector<PlannerInput> inputs,
                  const std::vector<LoggedStep>& steps);

/// The counts in one line.
std::string hearingLine(const Hearing& hearing);

}  // namespace tread::replay
