// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

#include <CLI/CLI.hpp>

#include "common/bus/host_clock.hpp"
#include "common/bus/lcm_bus.hpp"
#include "common/bus/shell.hpp"
#include "common/bus/tcp_relay.hpp"
#include "common/config/command_line.hpp"
#include "common/config/problem_words.hpp"
#include "common/seal/key_file.hpp"
#include "common/store/store.hpp"
#include "tools/robot/launch/host.hpp"
#include "tools/robot/launch/running_robots.hpp"
#include "tools/robot/launch/stall_watch.hpp"
#include "tools/robot/launch/supervision.hpp"

namespace {

using namespace tread;
using namespace tread::launch;

struct Options {
  LaunchSettings settings;
  std::vector<std::string> values;
  std::string only;
  bool check = false;
  bool status = false;
  bool stop = false;
  bool no_watchdog = false;
  std::optional<double> timing;  ///< [s]
  double longest_ms = 100.0;     ///< motor_bridge's limit, and the age limit of the INS
  bool pre_drive = false;
};

void declare(CLI::App& app, Options& options) {
  app.add_option("FILE", options.settings.file, "launch file (YAML), see config/launch")
      ->required();
  app.add_option("--run", options.settings.run,
                 "folder for states and logs; default ~/.local/state/tread/NAME");
  app.add_option("--lcm-url", options.settings.lcm_url, "LCM provider, instead of the file's");
  app.add_option(
         "--set", options.values,
         "KEY=VALUE: overrides one of the file's values; a relative path is resolved from the "
         "file's folder in program and config, from the run folder in arguments")
      ->expected(1)
      ->take_all();
  auto* check = app.add_flag("--check", options.check, "run only the start-up checks");
  auto* status = app.add_flag("--status", options.status, "show what runs in the run folder");
  auto* stop = app.add_flag("--stop", options.stop, "stop what runs in the run folder");
  auto* only = app.add_option("--only", options.only,
                              "run only this process, without a supervisor (for systemd)");
  app.add_flag("--no-watchdog", options.no_watchdog,
               "do not end processes without a sign of life: for a debugger, which halts them");
  app.add_flag(
      "--pre-drive", options.pre_drive,
      "agree to the 10 s drive that tests the wiring (pre_drive in the file); else it asks");
  app.add_option("--timing", options.timing,
                 "measure for so many seconds (0: until stopped) how long this machine keeps "
                 "a process waiting; exit status 3 if longer than --longest")
      ->check(CLI::Range(0.0, 86400.0))
      ->excludes(check)
      ->excludes(status)
      ->excludes(stop)
      ->excludes(only);
  app.add_option("--longest", options.longest_ms,
                 "limit for --timing [ms]; motor_bridge stops the motors above 100 ms")
      ->check(CLI::Range(1.0, 1e6))
      ->capture_default_str();
  check->excludes(status)->excludes(stop)->excludes(only);
  status->excludes(stop)->excludes(only);
  stop->excludes(only);
}

void complete(Options& options) {
  LaunchSettings& settings = options.settings;
  settings.file = std::filesystem::absolute(settings.file).lexically_normal().string();
  settings.bin = ownFolder();
  for (const std::string& pair : options.values) {
    const size_t equals = pair.find('=');
    if (equals == std::string::npos || equals == 0)
      throw std::runtime_error("--set " + pair + ": KEY=VALUE is needed");
    settings.values[pair.substr(0, equals)] = pair.substr(equals + 1);
  }
  if (settings.run.empty()) settings.run = defaultRunFolder(readLaunchName(settings.file));
  settings.run = std::filesystem::absolute(settings.run).lexically_normal().string();
  if (settings.run.size() > 1 && settings.run.back() == '/') settings.run.pop_back();
}

std::vector<SupervisedProcess> withCommands(const LaunchFile& launch,
                                            const LaunchSettings& settings) {
  std::vector<SupervisedProcess> supervised;
  for (const LaunchProcess& process : launch.processes) {
    const std::string program = findProgram(process.program, settings.bin);
    supervised.push_back({process, startCommand(process, program, launch.lcm_url, launch.key)});
  }
  return supervised;
}

[[noreturn]] void become(const std::vector<std::string>& words) {
  becomeProgram(words);
  throw std::runtime_error(words.front() + ": cannot be started");
}

/// Prints the start-up checks; false if a critical one fails.
bool checksPass(const LaunchFile& launch, const LaunchSettings& settings) {
  const std::vector<HostFinding> findings = checkHost(launch, settings);
  for (const HostFinding& finding : findings)
    std::cerr << findingLine(launch.name, finding) << std::endl;
  return !anyCritical(findings);
}

/// Asks for permission to move: nothing watches for obstacles yet, so a person must stand by.
bool mayMove(const LaunchFile& launch, bool agreed) {
  if (agreed) return true;
  if (isatty(STDIN_FILENO) == 0) {
    std::cout << launch.name
              << ": wiring not tested: no terminal to ask for permission, see --pre-drive"
              << std::endl;
    return false;
  }
  std::cout << launch.name
            << ": tests the wiring: 10 s back and forth within a metre, nothing detects "
            << "obstacles. Emergency stop at hand, go? [y/N] " << std::flush;
  std::string answer;
  std::getline(std::cin, answer);
  return answer == "y" || answer == "yes";
}

/// Tries the robot's wiring; false if there is a fault.
bool preDrivePasses(const LaunchFile& launch, const Options& options) {
  constexpr double kLongest = 120.0;  // [s]
  if (options.pre_drive && launch.pre_drive.empty())
    throw std::runtime_error(options.settings.file + ": names no robot under pre_drive");
  if (launch.pre_drive.empty() || !mayMove(launch, options.pre_drive)) return true;
  const std::string program = findProgram("tread-setup-robot", options.settings.bin);
  const CommandOutcome outcome = runCommand({program, "--pre-drive", launch.pre_drive}, kLongest);
  std::cout << outcome.output << std::flush;
  if (outcome.code == 0) return true;
  std::cerr << launch.name << ": nothing is started: the wiring is wrong" << std::endl;
  return false;
}

int start(const LaunchFile& launch, const Options& options) {
  const LaunchSettings& settings = options.settings;
  if (!checksPass(launch, settings)) return 1;
  const RunPaths paths(settings.run);
  std::filesystem::create_directories(paths.logs);
  const RunLock lock(paths.lock);
  // Files of a run that ended by a power failure.
  std::error_code none;
  for (const std::string& old : {paths.status, paths.pid}) std::filesystem::remove(old, none);
  if (const std::string line = provideKey(launch); !line.empty()) std::cout << line << std::endl;
  if (!preDrivePasses(launch, options)) return 1;
  std::optional<TcpRelay> relay;
  if (const auto address = parseLcmUrl(launch.lcm_url); address && address->provider == "tcpq")
    relay.emplace(address->port);
  std::cout << launch.name << ": starting " << launch.processes.size() << " processes; logs in "
            << paths.logs << std::endl;
  const Announcement announcement({launch.name, launch.lcm_url, launch.key});
  return supervise(launch.name, withCommands(launch, settings), paths, lock, !options.no_watchdog);
}

int only(const LaunchFile& launch, const Options& options) {
  for (const LaunchProcess& process : launch.processes) {
    if (process.name != options.only) continue;
    const std::string program = findProgram(process.program, options.settings.bin);
    if (program.empty()) throw std::runtime_error("there is no program " + process.program);
    std::filesystem::create_directories(RunPaths(options.settings.run).logs);
    std::filesystem::current_path(options.settings.run);
    provideKey(launch);
    become(startCommand(process, program, launch.lcm_url, launch.key));
  }
  throw std::runtime_error(options.settings.file + ": has no process '" + options.only + "'");
}

/// Problems that the processes report in HEALTH within a little more than one period; healthy ones
/// are absent.
std::map<std::string, std::string> troubles(const LaunchFile& launch) {
  constexpr int64_t kListen = 1'200'000;  // [us]
  std::map<std::string, std::string> lines;
  try {
    LcmBus bus(BusAccess{launch.lcm_url, hostSealer(launch.key)}, TimeSource::kHost);
    bus.subscribe<health_t>(kHealth, [&](const health_t& health) {
      lines.erase(health.process);
      if (health.health_state != health_t::HEALTH_OK) lines[health.process] = " " + inWords(health);
    });
    for (const int64_t end = hostNow() + kListen; hostNow() < end;) bus.handle(50);
  } catch (const std::exception& error) {
    lines["HEALTH"] = std::string(" cannot be received: ") + wordsOf(error);
  }
  return lines;
}

/// Processes that receive messages late. A single one may be at fault itself; several point to the
/// machine.
class LateMessages {
 public:
  /// An empty URL: no messages are received.
  LateMessages(const std::string& lcm_url, const std::string& key) {
    if (lcm_url.empty()) return;
    bus_.emplace(BusAccess{lcm_url, hostSealer(key)}, TimeSource::kHost);
    bus_->subscribe<health_t>(
        kHealth, [this](const health_t& health) { late_[health.process] = health.late > 0; });
  }
  void listenFor(int milliseconds) {
    if (bus_)
      bus_->handle(milliseconds);
    else
      std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  }
  int64_t processes() const {
    return std::count_if(late_.begin(), late_.end(), [](const auto& late) { return late.second; });
  }

 private:
  std::optional<LcmBus> bus_;
  std::map<std::string, bool> late_;
};

/// Measures whether this machine keeps real time: no process waits long, and messages arrive in
/// time.
int timing(const LaunchFile& launch, const Options& options) {
  constexpr int64_t kMostLate = 1;
  constexpr int kLookMs = 20;
  const std::atomic<bool>& stop = stopRequest(0);
  LateMessages late(options.settings.lcm_url, launch.key);
  const StallWatch watch;
  const auto end =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(*options.timing);
  while (!stop && std::chrono::steady_clock::now() < end) late.listenFor(kLookMs);
  const double wait_ms = 1e3 * watch.longest();
  const bool kept = wait_ms <= options.longest_ms && late.processes() <= kMostLate;
  std::cout << launch.name << ": this machine " << (kept ? "keeps" : "does not keep")
            << " real time: a process waited for " << std::lround(wait_ms) << " ms (at most "
            << std::lround(options.longest_ms) << "), messages came late to " << late.processes()
            << " processes" << std::endl;
  return kept ? 0 : 3;
}

int status(const LaunchFile& launch, const RunPaths& paths) {
  if (!RunLock::isHeld(paths.lock)) {
    std::cout << launch.name << ": nothing runs in " << paths.folder << std::endl;
    return 3;  // as systemctl does
  }
  for (const auto& [process, trouble] : troubles(launch))
    std::cout << process << trouble << std::endl;
  for (const std::string& path : {paths.hung, paths.status}) {
    std::ifstream file(path);
    for (std::string line; std::getline(file, line);) std::cout << line << std::endl;
  }
  return 0;
}

int run(int argc, char** argv) {
  CLI::App app{"Starts, watches and restarts the processes of a launch file.", "tread-launch"};
  Options options;
  declare(app, options);
  if (const auto code = parseCommandLine(app, argc, argv)) return *code;
  complete(options);
  ConfigReader reader = ConfigReader::fromFile(options.settings.file);
  LaunchFile launch = readLaunchFile(reader, options.settings);
  takeNamedKey(launch);
  const RunPaths paths(options.settings.run);
  if (options.timing) return timing(launch, options);
  if (options.stop) return stopRun(launch.name, paths);
  if (options.status) return status(launch, paths);
  if (!options.only.empty()) return only(launch, options);
  if (!options.check) return start(launch, options);
  if (!checksPass(launch, options.settings)) return 1;
  std::cout << launch.name << ": ready to start" << std::endl;
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::cerr << "tread-launch: " << wordsOf(error) << std::endl;
    return 1;
  }
}
