// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
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
  std::string config;  ///< for supervisord
  std::string socket;  ///< for supervisorctl
  std::string life;    ///< socket for signs of life
  std::string hung;    ///< which processes have hung since the start, one a line; may be absent
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
/** Both supervisord and supervisorctl must work in the run folder. */
std::string supervisorConfig(const std::string& name,
                             const std::vector<SupervisedProcess>& processes, bool as_root);

/// Words as one line that supervisor takes apart into the same words.
std::string supervisorCommand(const std::vector<std::string>& words);

/// A process that supervisord has started.
struct Spawned {
  std::string process;
  int pid;
};
/// What a line of supervisord's log (version 4.2) says: that one was started, or has ended.
std::optional<Spawned> spawnedIn(const std::string& log_line);
std::optional<std::string> endedIn(const std::string& log_line);

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
