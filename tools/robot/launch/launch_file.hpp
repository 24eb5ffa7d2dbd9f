// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"

namespace tread::launch {

/// One process of a launch file; every {placeholder} is replaced already.
struct LaunchProcess {
  std::string name;
  std::string program;                 ///< a path if it has a slash, else looked up (findProgram)
  std::string config;                  ///< absolute path for --config; empty = none
  std::vector<std::string> arguments;  ///< further words
  /// Not a program of ours: no --config, --lcm-url, --with-parent and --check are given to it.
  bool external = false;
  std::string stop_signal = "INT";  ///< asks it to end
  int64_t stop_time = 5;            ///< s until it is killed
  double start_time = 30.0;         ///< s until it must be ready
  double watchdog = 2.0;  ///< s without a sign of life after which it is ended; 0 = not watched
};

/// A launch file: what runs together, in the order of starting; stopped in the reverse order.
struct LaunchFile {
  std::string name;
  std::string lcm_url;
  std::string key;         ///< absolute path of the robot's key; empty = messages are not sealed
  bool makes_key = false;  ///< it is made at the first start
  bool simulated = false;  ///< no robot: what only a robot's network needs is an advice
  std::string
      pre_drive;  ///< folder of the robot whose wiring is tried before the start; empty: none
  std::vector<LaunchProcess> processes;
};

/// What the command line says; all paths absolute.
struct LaunchSettings {
  std::string file;     ///< the launch file
  std::string run;      ///< run folder; empty = defaultRunFolder() of the file's name
  std::string bin;      ///< folder of our programs
  std::string lcm_url;  ///< empty = the file's own
  std::map<std::string, std::string> values;  ///< replace values of the file
};

/// Name of a launch, for the default run folder; throws ConfigError.
std::string readLaunchName(const std::string& file);

/// Reads a launch file; throws ConfigError with file:line.
/** Without a key the file is a robot's, whose key is made in its run folder, or a simulated one;
 * `key: none` is a robot that takes messages from everybody. Keys: name, lcm_url, key, simulated,
 * pre_drive, values (further placeholders with their defaults) and processes, a list of maps: name,
 * program, config, arguments, external, stop_signal, stop_time, start_time, watchdog. Placeholders
 * in key, pre_drive, program, config and arguments: {run}, {lcm_url}, {bin}, {here} (the file's
 * folder) and those in `values`. Paths are relative to the file's folder. A value that names a file
 * or folder there becomes its absolute path. */
LaunchFile readLaunchFile(ConfigReader& reader, const LaunchSettings& settings);

/// The words that start a process: ours get --config, --lcm-url, --with-parent and, where there is
/// one, --key; external ones run under setpriv, so that neither outlives a killed supervisor.
std::vector<std::string> startCommand(const LaunchProcess& process, const std::string& program,
                                      const std::string& lcm_url, const std::string& key = "");

/// The words that make a program of ours check its configuration; empty for external ones.
std::vector<std::string> checkCommand(const LaunchProcess& process, const std::string& program,
                                      const std::string& lcm_url);

/// Where things of one run lie.
struct RunPaths {
  explicit RunPaths(const std::string& run);

  std::string folder;
  std::string lock;    ///< held while something runs here
  std::string life;    ///< socket for signs of life
  std::string hung;    ///< which processes have hung since the start, one a line; may be absent
  std::string status;  ///< how the processes are, one a line; there while something runs here
  std::string pid;     ///< of the supervisor
  std::string logs;    ///< folder with one NAME.log a process
  std::string supervisor_log;
};

/// A unix socket's path may have so many bytes.
constexpr size_t kMaxSocketPath = 107;

}  // namespace tread::launch
