// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::replay {

/// A report, and whether replay and log agree.
struct Verdict {
  std::string report;
  bool equal = false;
};

/// A robot's log through the learner. `config`: file of its configuration; empty = the log's own.
Verdict replayRobotLearner(const std::string& log, const std::string& config);

/// The same through the planner.
Verdict replayRobotPlanner(const std::string& log, const std::string& config);

}  // namespace tread::replay
