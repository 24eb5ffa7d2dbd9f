// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>

#include "common/drive/robot_log.hpp"
#include "modules/learner/learner_node.hpp"
#include "tools/lab/replay/replay_check.hpp"

namespace tread::replay {

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

}  // namespace tread::replay
