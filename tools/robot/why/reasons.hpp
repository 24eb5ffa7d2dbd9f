// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::why {

/// What a reason of motor_bridge or the planner is about. The order is how near to the cause it is:
/// of reasons that come together the first in this list is looked at first.
enum class Topic {
  kEstop,
  kFinder,      ///< a range finder that mapping does not believe
  kPerson,      ///< disarmed by somebody
  kController,  ///< the motor controller or its line
  kBridge,      ///< motor_bridge itself
  kOperator,    ///< the operator's lease
  kProgram,     ///< the planner's orders
  kInsBlind,    ///< no position or no heading
  kInsStale,
  kTilt,
  kFence,
  kMotion,  ///< what was measured does not fit what was commanded
  kMap,
  kPatterns,  ///< the pattern set, and the learner
  kObstacle,
  kPlan,  ///< the search finds nothing
  kGoal,
  kOther
};

/// Words of a reason and what they are about.
struct ReasonWords {
  const char* words;
  Topic topic;
  const char* in_source = nullptr;  ///< how a source file of modules has them, where not alike
};

const std::vector<ReasonWords>& reasonTable();

Topic topicOf(const std::string& reason);

/// Whether the reason says that nothing is wrong: stops that were planned, states at the start.
bool isOrdinary(const std::string& reason);

}  // namespace tread::why
