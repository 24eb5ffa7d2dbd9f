// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/robot/launch/checks.hpp"
#include "tools/robot/launch/launch_file.hpp"

namespace tread::launch {

/// The folder of the program that runs.
std::string ownFolder();

/// $XDG_STATE_HOME/tread/NAME or ~/.local/state/tread/NAME; throws std::runtime_error without HOME.
std::string defaultRunFolder(const std::string& name);

/// An executable file: a path as it is, a name beside our programs or in PATH; empty if none.
std::string findProgram(const std::string& word, const std::string& bin);

/// The start-up checks of a launch: all that is missing on this host.
std::vector<HostFinding> checkHost(const LaunchFile& launch, const LaunchSettings& settings);

/// For a run folder without asking for its owner.
FolderFacts folderFacts(const RunPaths& paths);

/// Becomes this program, looked up in PATH; returns only if it cannot be started.
void becomeProgram(std::vector<std::string> words);

/// How a command ended and what it said on both outputs.
struct CommandOutcome {
  int code = -1;  ///< 127 = could not be started, 124 = took too long
  std::string output;
};

/// Runs a command to its end, at most so many seconds.
CommandOutcome runCommand(const std::vector<std::string>& words, double seconds);

/// The processes take TREAD_KEY where the launch file names no key.
void takeNamedKey(LaunchFile& launch);
/// Makes the key of a robot that has none yet, and says in a line where it is and how a station
/// gets it; empty where the launch has none. Throws as readKey() does.
std::string provideKey(const LaunchFile& launch);

/// The lock of a run folder: held by tread-launch and by its supervisor.
/** Two locks on one file. The one of flock(2) is passed on to the supervisor and is free only when
 * both have gone, also by SIGKILL; the one of fcntl(2) is tread-launch's own and tells its pid. */
class RunLock {
 public:
  /// Takes the lock; throws std::runtime_error with one line if it is held or cannot be made.
  explicit RunLock(const std::string& path);
  ~RunLock();
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

  int descriptor() const { return descriptor_; }

  static bool isHeld(const std::string& path);
  /// The pid of the tread-launch that holds it; 0 if none does.
  static int owner(const std::string& path);

 private:
  int descriptor_ = -1;
};

/// A process with the words that start it.
struct SupervisedProcess {
  LaunchProcess process;
  std::vector<std::string> command;
};

/// Runs the processes until they are stopped; tells on standard output what happens. Returns the
/// exit code of tread-launch.
/** They are children of a supervisor, a process of its own (ProcessKeeper). Where `watch` is set,
 * processes that hang are aborted, and told there and in the file paths.hung. SIGINT, SIGTERM and
 * SIGHUP stop everything in order. If the supervisor dies, its processes become our children
 * (PR_SET_CHILD_SUBREAPER): they are asked to end, and killed after the longest stop_time. If we
 * die, the supervisor gets SIGTERM and stops everything in order. */
int supervise(const std::string& name, const std::vector<SupervisedProcess>& processes,
              const RunPaths& paths, const RunLock& lock, bool watch);

/// Asks the tread-launch that runs in this folder to stop, and waits for it.
int stopRun(const std::string& name, const RunPaths& paths);

}  // namespace tread::launch
