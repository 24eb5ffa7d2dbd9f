// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::launch {

/// Becomes this program, looked up in PATH; returns only if it cannot be started.
void becomeProgram(std::vector<std::string> words);

/// How a command ended and what it said on both outputs.
struct CommandOutcome {
  int code = -1;  ///< 127 = could not be started, 124 = took too long
  std::string output;
};

/// Runs a command to its end, at most so many seconds.
CommandOutcome runCommand(const std::vector<std::string>& words, double seconds);

}  // namespace tread::launch
