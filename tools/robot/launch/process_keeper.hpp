// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <csignal>
#include <string>
#include <vector>

#include "tools/robot/launch/host.hpp"
#include "tools/robot/launch/supervision.hpp"

namespace tread::launch {

/// The processes of a supervisor.
struct KeptProcesses {
  std::string launch;  ///< name of the launch, for messages
  std::vector<SupervisedProcess> processes;
  RunPaths paths;
  bool watch;     ///< end processes that hang
  sigset_t mask;  ///< signal mask of the processes
};

/// Turns this process, a new child of `parent`, into the supervisor. It starts the processes,
/// restarts those that end, and stops them in order at SIGTERM or when the parent dies.
/** It keeps the lock and closes all other descriptors of its parent. Output of the processes goes
 * to log/NAME.log, which is rotated at 5 MB; three old ones are kept. */
[[noreturn]] void becomeKeeper(const KeptProcesses& kept, const RunLock& lock, pid_t parent);

}  // namespace tread::launch
