// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

namespace tread::blindtest {

/// A command and where it runs.
struct Child {
  std::vector<std::string> command;
  std::string folder;  ///< it begins here
  std::string log;     ///< what it prints, below `folder`
  int cpu_limit = 0;   ///< [s] of a run that does not end; 0 = none
};

/// How it ended.
struct Ended {
  int status = -1;           ///< exit status; 128 + signal where it was killed
  double cpu_seconds = 0.0;  ///< user and system
};

/// Runs a command to its end.
Ended run(const Child& child);

/// The same, with the end of what it printed in a std::runtime_error unless it ends with 0.
void runOrThrow(const Child& child);

/// The last line of a file that is not empty; "" if there is none.
std::string lastLine(const std::string& path);

}  // namespace tread::blindtest
