// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace tread {

/// What every process takes from its command line.
struct ShellArguments {
  std::string config_path;  ///< --config; empty = defaults
  std::string lcm_url;      ///< --lcm-url; empty = LCM_DEFAULT_URL or LCM's own default
};

/// The main function of a process: reads --config, --lcm-url and --help, turns SIGINT and SIGTERM
/// into `stop`, and ends with one clear line and code 1 where the body throws. Usage errors end
/// with code 2.
int runShell(int argc, char** argv, const std::string& name, const std::string& description,
             const std::function<void(const ShellArguments&, const std::atomic<bool>& stop)>& body);

}  // namespace tread
