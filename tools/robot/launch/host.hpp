// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/robot/launch/checks.hpp"
#include "tools/robot/launch/launch_file.hpp"

namespace tread::launch {

/// Folder of the running executable.
std::string ownFolder();

/// $XDG_STATE_HOME/tread/NAME or ~/.local/state/tread/NAME; throws std::runtime_error without HOME.
std::string defaultRunFolder(const std::string& name);

/// Path of an executable: a path as given, a name next to our programs or in PATH; empty if none.
std::string findProgram(const std::string& word, const std::string& bin);

/// Start-up checks: everything that is missing on this host.
std::vector<HostFinding> checkHost(const LaunchFile& launch, const LaunchSettings& settings);

/// State of a run folder, without its owner.
FolderFacts folderFacts(const RunPaths& paths);

/// Replaces this process by the program, which is looked up in PATH; returns only on failure.
void becomeProgram(std::vector<std::string> words);

/// Exit code and output (both streams) of a command.
struct CommandOutcome {
  int code = -1;  ///< 127 = not started, 124 = timed out
  std::string output;
};

/// Runs a command for at most so many seconds.
CommandOutcome runCommand(const std::vector<std::string>& words, double seconds);

/// Takes TREAD_KEY if the launch file names no key.
void takeNamedKey(LaunchFile& launch);
/// Creates the key of a robot that has none, and returns a line with its path and how a station
/// gets it; empty if the launch has no key. Throws as readKey() does.
std::string provideKey(const LaunchFile& launch);

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
