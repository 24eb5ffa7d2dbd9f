// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/learner/learner_config.hpp"
#include "tools/replay/robot_log.hpp"

namespace tread::replay {

/// The log of a robot's drive through the learner: what it holds, what came out, how they compare.
/** The learner begins as the first LEARNER_STATE of each of its lives in the log says, and hears
 * INS, MOTOR and EXECUTION. Compared: PATTERN_SET part by part and version by version, LEARNING per
 * execution; to the bit where the log holds the learner's start. */
struct LearnerCheck {
  std::string name;
  int lives = 0;           ///< starts of the learner, with the one under way when the log begins
  bool from_start = true;  ///< the log holds the start of the first life
  double tolerance = 0.0;  ///< of numbers; 0 = to the bit
  int64_t first_version = 0;
  int64_t last_version = 0;
  int64_t versions_equal = 0;
  int64_t versions_different = 0;
  int64_t versions_only_in_log = 0;
  int64_t versions_only_in_replay = 0;  ///< the recorder lost them, or recorded no further
  int64_t learning_equal = 0;
  int64_t learning_different = 0;
  int64_t learning_only_in_log = 0;
  int64_t learning_only_in_replay = 0;
  int64_t measured = 0;          ///< executions that the replay measured; the others were refused
  std::string first_difference;  ///< in words; empty = none
  bool same_twice = true;        ///< a second replay published the same bytes
  std::vector<std::string> notes;

  /// Whether the replay says what the log says, and says it twice. The replay may say more: as many
  /// messages as the log lacks by seq, and what comes after the learner's last word in the log.
  bool equal() const;
};

/// The learner's configuration as the log's CONFIG has it, with the shipped set that it names.
/** The set is found by its checksum: as the log's first version, else among the pattern files of
 * `patterns_folder`. Throws std::runtime_error with one clear line. */
learner::LearnerNodeConfig learnerConfigOf(const RobotLog& log, const std::string& patterns_folder);

/// Replays the log twice and compares. Throws std::runtime_error with one clear line if the log
/// does not say where the learner began.
LearnerCheck checkLearner(const RobotLog& log, const learner::LearnerNodeConfig& config);

/// A few lines of text.
std::string reportOf(const LearnerCheck& check);

}  // namespace tread::replay
