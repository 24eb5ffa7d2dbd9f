// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include "common/drive/robot_log.hpp"
#include "common/pattern/pattern.hpp"
#include "modules/learner/core/learner.hpp"

namespace tread::replay {

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

}  // namespace tread::replay
