// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "modules/learner/learner_node.hpp"
#include "tools/replay/learner_log.hpp"

namespace tread::replay {

/// Which set an execution is scored with.
enum class Commitment {
  kAhead,   ///< the newest when it began: what a planner knew, which commits to patterns early
  kPrompt,  ///< the newest when it ended: corrections of all executions before it are known
};

/// One run of the learner over a log.
struct LearnerRun {
  std::string title;
  std::vector<learning_t> learned;          ///< one per execution, in order of their end
  std::map<std::string, int64_t> counters;  ///< the last of HEALTH
  std::string health;                       ///< last line of HEALTH; empty if all is well
};

/// Feeds a log to the real learner node on the virtual bus, from an empty store. Deterministic.
LearnerRun runLearner(const DriveLog& log, const learner::LearnerNodeConfig& config,
                      Commitment commitment, const std::string& title);

}  // namespace tread::replay
