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
  bool foreign = false;
  std::string stop_signal = "INT";  ///< asks it to end
  int64_t stop_time = 5;            ///< s until it is killed
};

/// A launch file: what runs together, in the order of starting; stopped in the reverse order.
struct LaunchFile {
  std::string name;
  std::string lcm_url;
  bool simulated = false;  ///< no robot: what only a robot's network needs is an advice
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
/** Keys: name, lcm_url, simulated, values (further placeholders with their defaults) and
 * processes, a list of maps: name, program, config, arguments, foreign, stop_signal, stop_time.
 * Placeholders in program, config and arguments: {run}, {lcm_url}, {bin}, {here} (the file's
 * folder) and those in `values`. Paths are relative to the file's folder. A value that names a file
 * or folder there becomes its absolute path. */
LaunchFile readLaunchFile(ConfigReader& reader, const LaunchSettings& settings);

/// The words that start a process: ours get --config, --lcm-url and --with-parent, foreign ones
/// run under setpriv, so that neither outlives a killed supervisor.
std::vector<std::string> startCommand(const LaunchProcess& process, const std::string& program,
                                      const std::string& lcm_url);

/// The words that make a program of ours check its configuration; empty for foreign ones.
std::vector<std::string> checkCommand(const LaunchProcess& process, const std::string& program,
                                      const std::string& lcm_url);

}  // namespace tread::launch
