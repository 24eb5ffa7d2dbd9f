// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/replay/shadow_learners.hpp"

namespace tread::report {

/// The executions of one drive, predicted by several rules of learning.
struct RuleErrors {
  std::string problem;  ///< why there are none, one line; empty = there are
  std::string driven;   ///< rule that the robot drove with
  std::vector<learner::Rule> rules;
  std::vector<shadow::ShadowedExecution> executions;  ///< in the order in which they ended
};

/// Replays the log's INS, EXECUTION and MOTOR through a learner process for each rule.
/** Configured as the log's CONFIG of the learner says, with the shipped set that it names: in the
 * log, or among the pattern files of `patterns_folder`. Each begins with that set and remembers no
 * surface, whatever the robot had learned before. `logs`: parts of one recording, in order. */
RuleErrors errorsByRule(const std::vector<std::string>& logs, const std::string& patterns_folder,
                        const std::vector<learner::Rule>& rules);

/// Means side by side, some lines. `changes`: when the ground became another [us], ascending;
/// empty = not known.
std::string reportOf(const RuleErrors& errors, const std::vector<int64_t>& changes);

}  // namespace tread::report
