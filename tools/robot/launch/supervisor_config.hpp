// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

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

}  // namespace tread::launch
