// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tools/robot/launch/launch_file.hpp"

namespace tread::launch {

/// Where things of one run lie.
struct RunPaths {
  explicit RunPaths(const std::string& run);

  std::string folder;
  std::string lock;    ///< held while something runs here
  std::string config;  ///< for supervisord
  std::string socket;  ///< for supervisorctl
  std::string pid;     ///< of supervisord
  std::string logs;    ///< folder with one NAME.log a process
  std::string supervisor_log;
};

/// A unix socket's path may have 107 bytes; supervisord binds one with its pid behind it first.
constexpr size_t kMaxSocketPath = 107 - 8;

/// A process with the words that start it.
struct SupervisedProcess {
  LaunchProcess process;
  std::vector<std::string> command;
};

/// The configuration of Debian's supervisor for one run; `as_root` if root runs it.
/** Throws std::invalid_argument, one line, for what its format cannot hold. */
std::string supervisorConfig(const std::string& name,
                             const std::vector<SupervisedProcess>& processes, const RunPaths& paths,
                             bool as_root);

/// Words as one line that supervisor takes apart into the same words.
std::string supervisorCommand(const std::vector<std::string>& words);

/// Turns supervisord's log (version 4.2) into a few lines for people: that all processes run, which
/// one ended and how, that it runs again.
class LaunchProgress {
 public:
  LaunchProgress(std::string name, size_t processes);
  /// What to print for a line of the log, if anything; `seconds` since the start.
  std::optional<std::string> lineFor(const std::string& log_line, double seconds);
  /// Whether a line of the log says that a process ended by itself.
  static bool isEnd(const std::string& log_line);

 private:
  std::optional<std::string> running(const std::string& process, double seconds);
  std::optional<std::string> ended(const std::string& process, const std::string& how);

  std::string name_;
  size_t processes_;
  std::set<std::string> ran_;        ///< have run at least once
  std::map<std::string, int> ends_;  ///< how often in a row; absent = runs
};

}  // namespace tread::launch
