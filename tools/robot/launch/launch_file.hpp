// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"

namespace tread::launch {

/// One process of a launch file, placeholders replaced.
struct LaunchProcess {
  std::string name;
  std::string program;  ///< a path if it contains a slash, else a name for findProgram
  std::string config;   ///< absolute path for --config; empty = none
  std::vector<std::string> arguments;  ///< additional arguments
  /// Another project's program: it gets no --config, --lcm-url, --with-parent and --check.
  bool external = false;
  std::string stop_signal = "INT";  ///< asks the process to end
  int64_t stop_time = 5;            ///< s until SIGKILL
  double start_time = 30.0;         ///< s within which it must be ready
  double watchdog = 2.0;  ///< s without a sign of life until it is aborted; 0 = not watched
};

/// A launch file: its processes in starting order; they are stopped in reverse order.
struct LaunchFile {
  std::string name;
  std::string lcm_url;
  std::string key;         ///< absolute path of the robot's key; empty = messages are not sealed
  bool makes_key = false;  ///< created at the first start
  bool simulated = false;  ///< no real robot: requirements on a robot's network are only advice
  /// Folder of the robot whose wiring is tried before the start; empty: none
  std::string pre_drive;
  std::vector<LaunchProcess> processes;
};

/// Settings of the command line; all paths absolute.
struct LaunchSettings {
  std::string file;     ///< the launch file
  std::string run;      ///< run folder; empty = defaultRunFolder() of the launch's name
  std::string bin;      ///< folder of our programs
  std::string lcm_url;  ///< empty = that of the file
  std::map<std::string, std::string> values;  ///< override values of the file
};

/// Name of a launch, for the default run folder; throws ConfigError.
std::string readLaunchName(const std::string& file);

/// Reads a launch file; throws ConfigError with file:line.
/** If `key` is absent, a robot's key is created in its run folder, and a simulated launch has none.
 * `key: none` accepts messages from everybody. Keys: name, lcm_url, key, simulated, pre_drive,
 * values (further placeholders with their defaults) and processes, a list of maps: name, program,
 * config, arguments, external, stop_signal, stop_time, start_time, watchdog. Placeholders in key,
 * pre_drive, program, config and arguments: {run}, {lcm_url}, {bin}, {here} (the file's folder)
 * and the names in `values`. Paths are relative to the file's folder. A value that names a file or
 * folder there becomes its absolute path. */
LaunchFile readLaunchFile(ConfigReader& reader, const LaunchSettings& settings);

/// Command line of a process. Ours get --config, --lcm-url, --with-parent and, if there is one,
/// --key; external ones run under setpriv. Neither outlives a killed supervisor.
std::vector<std::string> startCommand(const LaunchProcess& process, const std::string& program,
                                      const std::string& lcm_url, const std::string& key = "");

/// Command line that checks a configuration; empty for external programs.
std::vector<std::string> checkCommand(const LaunchProcess& process, const std::string& program,
                                      const std::string& lcm_url);

/// Paths of one run.
struct RunPaths {
  explicit RunPaths(const std::string& run);

  std::string folder;
  std::string lock;    ///< held while the launch runs
  std::string life;    ///< socket for signs of life
  std::string hung;    ///< processes that have hung since the start, one per line; may be absent
  std::string status;  ///< state of the processes, one per line; exists while the launch runs
  std::string pid;     ///< of the supervisor
  std::string logs;    ///< folder with NAME.log for each process
  std::string supervisor_log;
};

/// Longest path of a unix socket [byte].
constexpr size_t kMaxSocketPath = 107;

}  // namespace tread::launch
