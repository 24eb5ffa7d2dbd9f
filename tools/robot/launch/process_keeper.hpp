// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <csignal>
#include <string>
#include <vector>

#include "tools/robot/launch/host.hpp"

namespace tread::launch {

/// What a supervisor is to keep running.
struct KeptProcesses {
  std::string launch;  ///< its name, for messages
  std::vector<SupervisedProcess> processes;
  RunPaths paths;
  bool watch;     ///< ends processes that hang
  sigset_t mask;  ///< of signals, for the processes
};

/// Makes this process, a new child of `parent`, the supervisor: starts the processes, starts again
/// those that end, and stops them in order at SIGTERM, or when the parent dies.
/** It holds the lock, and closes all else that its parent had open. What the processes print goes
 * to log/NAME.log, which is emptied at 5 MB; three old ones are kept. */
[[noreturn]] void becomeKeeper(const KeptProcesses& kept, const RunLock& lock, pid_t parent);

}  // namespace tread::launch
