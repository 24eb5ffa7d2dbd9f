// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/robot/launch/launch_file.hpp"

namespace tread::launch {

/// Which processes hang: those that run, but have given no sign of life (LifeSign) for too long.
/** They are aborted, which may leave a core (halted ones are killed at once), and killed a second
 * later if they are still there; what restarts crashed processes restarts them, too. */
class Liveness {
 public:
  /// External processes give no signs and are not watched.
  explicit Liveness(const std::vector<LaunchProcess>& processes);

  void started(const std::string& process, int pid);
  void ended(const std::string& process) { running_.erase(process); }
  /// What the process of this pid has said.
  void hear(int pid, const std::string& lines);

  struct Hung {
    std::string process;
    int pid;
    bool kill;         ///< it was aborted before
    std::string line;  ///< what to tell people
  };
  /// Time passes [s], in which the signs of life were listened to; returns who is to be ended.
  std::vector<Hung> pass(double seconds);

 private:
  /// A process that runs.
  struct Watched {
    int pid;
    bool ready = false;
    bool stopping = false;
    bool aborted = false;
    double silence = 0.0;  ///< [s]
  };
  /// Nothing while it may be silent for longer.
  std::vector<Hung> judge(const std::string& process, Watched& watched) const;

  std::map<std::string, LaunchProcess> processes_;
  std::map<std::string, Watched> running_;
};

}  // namespace tread::launch
