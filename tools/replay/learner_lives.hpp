// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/learner/core/state_text.hpp"
#include "modules/learner/learner_config.hpp"
#include "tools/replay/robot_log.hpp"

namespace tread::replay {

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
