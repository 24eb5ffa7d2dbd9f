// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/learner/core/state_text.hpp"
#include "modules/learner/learner_config.hpp"
#include "tools/replay/replay_check.hpp"
#include "tools/replay/robot_log.hpp"

namespace tread::replay {

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

/// The learner's configuration as the log's CONFIG has it, with the shipped set that it names.
/** The set is found by its checksum: as the log's first version, else among the pattern files of
 * `patterns_folder`. Throws std::runtime_error with one clear line. */
learner::LearnerNodeConfig learnerConfigOf(const RobotLog& log, const std::string& patterns_folder);

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

}  // namespace tread::replay
