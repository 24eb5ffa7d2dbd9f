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

/// A robot's log through the learner.
/** In each of its lives the learner begins with the life's first LEARNER_STATE and receives INS,
 * MOTOR and EXECUTION. Compared: PATTERN_SET part by part and version by version, LEARNING per
 * execution; to the bit where the log holds the learner's start. */
struct LearnerCheck : ReplayCheck {
  bool from_start = true;  ///< the log holds the start of the first life
  double tolerance = 0.0;  ///< of numbers; 0 = to the bit
  int64_t first_version = 0;
  int64_t last_version = 0;
  MessageCounts versions;  ///< of PATTERN_SET
  MessageCounts learning;  ///< LEARNING, by execution
  int64_t measured = 0;    ///< executions that the replay measured; it refused the others

  /// Whether both replays published what the log holds. They may publish more: as many messages as
  /// the log lacks by seq, and those after the learner's last message in the log.
  bool equal() const;
};

/// Replays the log twice and compares. Throws std::runtime_error with one clear line if the log
/// does not say where the learner began.
LearnerCheck checkLearner(const RobotLog& log, const learner::LearnerNodeConfig& config);

/// A few lines of text.
std::string reportOf(const LearnerCheck& check);

/// One life of the learner in a log: from a start of the process to the next.
struct LearnerLife {
  size_t first_event = 0;  ///< index in the log
  size_t end_event = 0;    ///< one past the last
  int64_t boot_id = 0;
  bool from_start = false;          ///< the log holds its start
  learner::LearnerState state;      ///< the first that the log holds
  std::vector<PatternSet> earlier;  ///< versions before it that executions may still name
};

/// The lives in a log, in order. Throws std::runtime_error with one clear line if the log holds no
/// whole state, or states of another shipped set.
std::vector<LearnerLife> learnerLives(const RobotLog& log, const PatternSet& shipped);

/// A robot's log through the planner.
/** The planner steps when the log's planner did (utime of PROGRAM) and has then received what that
 * one had received (newest_input, inputs_heard). Searches end by a count of expansions: the
 * configured one, or that of the log's PLAN where the deadline cut the search on the robot.
 * Compared per step, to the bit: PROGRAM and PLAN without seq and search_time. */
struct PlannerCheck : ReplayCheck {
  int compared = 0;  ///< lives whose start the log holds; the others cannot be compared
  int64_t steps = 0;
  int64_t searches_cut = 0;  ///< by the deadline on the robot
  MessageCounts programs;
  MessageCounts plans;
  int64_t plans_lost = 0;  ///< PLANs that the log lacks, by seq
  int64_t lacking = 0;     ///< messages that the planners had received and the log lacks

  /// Whether both replays published what the log holds. Of the PLANs that only the replay has the
  /// recorder lost as many as seq shows; nothing compared is not equal.
  bool equal() const {
    return same_twice && programs.equal > 0 && programs.different == 0 && plans.different == 0 &&
           plans.only_in_log == 0 && plans.only_in_replay <= plans_lost;
  }
};

/// The planner's configuration as the log's CONFIG has it. Throws std::runtime_error with one clear
/// line.
planner::PlannerConfig plannerConfigOf(const RobotLog& log,
                                       const std::vector<std::string>& overrides = {});

/// Replays the log twice and compares. Throws std::runtime_error with one clear line if the log
/// holds no PROGRAM.
PlannerCheck checkPlanner(const RobotLog& log, const planner::PlannerConfig& config);

/// A few lines of text.
std::string reportOf(const PlannerCheck& check);

/// A message for the planner: its place in the log, and its channel, utime and seq.
struct PlannerInput {
  size_t event = 0;
  Receipt receipt;
};

/// The log's messages on the planner's channels that can be decoded, in the order of the log.
std::vector<PlannerInput> plannerInputs(const RobotLog& log, const planner::PlannerConfig& config);

/// A step of the planner in the log.
struct LoggedStep {
  program_t program;
  bool lost = false;  ///< the log lacks its PROGRAM: only `utime` is known, and only about
};

/// The messages of the log that a planner had received before each of its steps.
struct Hearing {
  std::vector<PlannerInput> inputs;  ///< in the order in which the planner heard them
  size_t from = 0;                   ///< the first of them that it heard
  std::vector<size_t> until;         ///< by step: the first that it had not heard yet
  int64_t by_time = 0;               ///< steps whose newest message the log lacks: assigned by time
  int64_t reordered = 0;  ///< pairs of messages that the recorder heard in the other order
  int64_t lacking = 0;    ///< messages that the planner had heard and the log lacks
  int64_t beyond = 0;     ///< messages of the log that the planner had not heard
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
