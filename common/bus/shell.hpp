// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <sys/types.h>

#include "common/bus/lcm_bus.hpp"
#include "common/config/config_reader.hpp"

namespace tread {

/// What a process does once its configuration is read: runs on this bus until `stop`.
struct ShellBody {
  using Run = std::function<void(BusAccess access, const std::atomic<bool>& stop)>;
  template <class Callable>
  ShellBody(Callable body, std::function<void()> attempt = {})
      : run(std::move(body)), trial(std::move(attempt)) {}

  Run run;
  /// With --check: warnings, one line each, for settings that are allowed but have no effect.
  std::vector<std::string> warnings;
  /// With --check: tests that resources are free, for instance a port; throws with one clear line.
  std::function<void()> trial;
};
/// Reads the whole configuration without opening anything; throws ConfigError.
using ShellPreparation = std::function<ShellBody(ConfigReader& reader)>;

/// Becomes true by SIGINT, SIGTERM or SIGHUP (a closed terminal; not under nohup), and, where
/// `parent` is not 0, as soon as that process is no longer our parent.
const std::atomic<bool>& stopRequest(pid_t parent);

/// The main function of a process.
/** Command line: --config FILE, --set KEY=VALUE (repeatable), --lcm-url URL, --key FILE (only
 * sealed messages), --check (only reads configuration and key, tests that resources are free, and
 * prints the effective configuration below its warnings as comments), --with-parent (ends as by
 * SIGINT when the parent process is gone: a killed supervisor leaves nothing driving), --help.
 * stopRequest() becomes `stop`. After an exception, one clear line and code 1; usage errors end
 * with code 2. */
int runShell(int argc, char** argv, const std::string& name, const std::string& description,
             const ShellPreparation& prepare);

}  // namespace tread
