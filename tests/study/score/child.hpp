// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::blindtest {

/// A command and its working folder.
struct Child {
  std::vector<std::string> command;
  std::string folder;  ///< working folder
  std::string log;     ///< its output, below `folder`
  int cpu_limit = 0;   ///< [s] for a run that does not end; 0 = none
};

/// Result of a command.
struct Ended {
  int status = -1;           ///< exit status; 128 + signal if it was killed
  double cpu_seconds = 0.0;  ///< user and system
};

/// Runs a command to its end.
Ended run(const Child& child);

/// The same; throws std::runtime_error with the end of its output unless it ends with 0.
void runOrThrow(const Child& child);

/// The last non-empty line of a file; "" if there is none.
std::string lastLine(const std::string& path);

}  // namespace tread::blindtest
