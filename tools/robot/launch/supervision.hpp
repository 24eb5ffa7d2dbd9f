// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "tools/robot/launch/launch_file.hpp"

namespace tread::launch {

/// Lock of a run folder, held by tread-launch and its supervisor.
/** There are two locks on one file. The supervisor inherits that of flock(2), which is free when
 * both processes have ended, also by SIGKILL. That of fcntl(2) belongs to tread-launch and yields
 * its pid. */
class RunLock {
 public:
  /// Throws std::runtime_error with one line if the lock is held or cannot be created.
  explicit RunLock(const std::string& path);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

  int descriptor() const { return descriptor_; }

  static bool isHeld(const std::string& path);
  /// Pid of the tread-launch that holds it; 0 if none.
  static int owner(const std::string& path);

 private:
  int descriptor_ = -1;
};

/// A process and its command line.
struct SupervisedProcess {
  LaunchProcess process;
  std::vector<std::string> command;
};

/// Runs the processes until they are stopped and prints events on standard output. Returns the exit
/// code of tread-launch.
/** They are children of a supervisor process (ProcessKeeper). If `watch` is set, hanging processes
 * are aborted, reported and written to paths.hung. SIGINT, SIGTERM and SIGHUP stop everything in
 * order. If the supervisor dies, its processes become our children (PR_SET_CHILD_SUBREAPER) and
 * get SIGTERM, after the longest stop_time SIGKILL. If we die, the supervisor gets SIGTERM and
 * stops everything in order. */
int supervise(const std::string& name, const std::vector<SupervisedProcess>& processes,
              const RunPaths& paths, const RunLock& lock, bool watch);

/// Asks the tread-launch that runs in this folder to stop, and waits until it has.
int stopRun(const std::string& name, const RunPaths& paths);

}  // namespace tread::launch
