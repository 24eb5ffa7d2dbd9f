// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/robot/launch/launch_file.hpp"

namespace tread::launch {

/// Detects processes that hang: they run without a sign of life (LifeSign) for too long.
/** They get SIGABRT, which may leave a core dump (halted ones get SIGKILL at once), and SIGKILL a
 * second later. The supervisor restarts them like crashed processes. */
class Liveness {
 public:
  /// External processes send no signs of life and are not watched.
  explicit Liveness(const std::vector<LaunchProcess>& processes);

  void started(const std::string& process, int pid);
  void ended(const std::string& process) { running_.erase(process); }
  /// Handles signs of life of the process `pid`.
  void hear(int pid, const std::string& lines);

  struct Hung {
    std::string process;
    int pid;
    bool kill;         ///< SIGKILL: SIGABRT was sent before
    std::string line;  ///< message for people
  };
  /// Advances the time by `seconds` in which signs of life could arrive; returns the processes to
  /// end.
  std::vector<Hung> pass(double seconds);

 private:
  /// A running process.
  struct Watched {
    int pid;
    bool ready = false;
    bool stopping = false;
    bool aborted = false;
    double silence = 0.0;  ///< [s]
  };
  /// nullopt while the process may still be silent.
  std::vector<Hung> judge(const std::string& process, Watched& watched) const;

  std::map<std::string, LaunchProcess> processes_;
  std::map<std::string, Watched> running_;
};

}  // namespace tread::launch
