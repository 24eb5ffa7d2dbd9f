// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/host.hpp"

#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include <sys/statvfs.h>
#include <unistd.h>

#include "tools/robot/launch/multicast.hpp"
#include "tools/robot/launch/run_command.hpp"
#include "tools/robot/launch/run_lock.hpp"

namespace tread::launch {
namespace {

namespace fs = std::filesystem;

std::string firstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

bool isProgram(const std::string& path) {
  std::error_code none;
  return fs::is_regular_file(path, none) && access(path.c_str(), X_OK) == 0;
}

/// The address in a configuration file, whatever else stands there; empty if none can be read.
std::string configuredAddress(const std::string& path) {
  std::string address;
  try {
    ConfigReader reader = ConfigReader::fromFile(path);
    reader.text("address", address);
  } catch (const ConfigError&) {
    return "";  // the program's own --check tells what is wrong with the file
  }
  return address;
}

ProcessFacts processFacts(const LaunchProcess& process, const std::string& lcm_url,
                          const LaunchSettings& settings) {
  ProcessFacts facts;
  facts.name = process.name;
  facts.program = process.program;
  const std::string program = findProgram(process.program, settings.bin);
  facts.program_found = !program.empty();
  facts.config = process.config;
  facts.config_readable = process.config.empty() || access(process.config.c_str(), R_OK) == 0;
  const auto check = checkCommand(process, program, lcm_url);
  if (facts.program_found && facts.config_readable && !check.empty()) {
    const CommandOutcome outcome = runCommand(check, 10.0);
    facts.check_code = outcome.code;
    facts.check_line = firstLine(outcome.output);
  }
  const std::string address =
      process.config.empty() || !facts.config_readable ? "" : configuredAddress(process.config);
  facts.device = deviceOf(process.arguments, address, settings.run);
  facts.device_present = access(facts.device.c_str(), F_OK) == 0;
  facts.device_usable = access(facts.device.c_str(), R_OK | W_OK) == 0;
  return facts;
}

}  // namespace

std::string ownFolder() {
  return fs::read_symlink("/proc/self/exe").parent_path().string();
}

std::string defaultRunFolder(const std::string& name) {
  if (const char* state = std::getenv("XDG_STATE_HOME"); state != nullptr && *state == '/')
    return std::string(state) + "/tread/" + name;
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/')
    return std::string(home) + "/.local/state/tread/" + name;
  throw std::runtime_error("there is no HOME for the run folder; name one with --run DIR");
}

std::string findProgram(const std::string& word, const std::string& bin) {
  if (word.find('/') != std::string::npos) return isProgram(word) ? word : "";
  if (isProgram(bin + "/" + word)) return bin + "/" + word;
  const char* path = std::getenv("PATH");
  std::istringstream folders(path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (std::string file = folder.append("/").append(word); isProgram(file)) return file;
  return "";
}

FolderFacts folderFacts(const RunPaths& paths) {
  FolderFacts facts;
  facts.path = paths.folder;
  facts.longest_socket = paths.socket.size();
  // A folder that is not there yet counts as writable if its nearest parent is.
  fs::path nearest = paths.folder;
  std::error_code none;
  while (!fs::exists(nearest, none) && nearest.has_relative_path()) nearest = nearest.parent_path();
  facts.writable = fs::is_directory(nearest, none) && access(nearest.c_str(), W_OK | X_OK) == 0;
  struct statvfs disk {};
  if (statvfs(nearest.c_str(), &disk) == 0)
    facts.free_bytes = static_cast<int64_t>(disk.f_bavail) * static_cast<int64_t>(disk.f_frsize);
  facts.occupied = RunLock::isHeld(paths.lock);
  facts.owner = RunLock::owner(paths.lock);
  return facts;
}

std::vector<Finding> checkHost(const LaunchFile& launch, const LaunchSettings& settings) {
  std::vector<Finding> findings;
  const auto add = [&](const std::vector<Finding>& more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  add(checkFolder(folderFacts(RunPaths(settings.run))));
  if (findProgram("supervisord", "").empty())
    findings.push_back(missingTool("supervisord", "supervisor"));
  if (findProgram("setpriv", "").empty()) findings.push_back(missingTool("setpriv", "util-linux"));
  if (const auto address = parseLcmUrl(launch.lcm_url))
    add(checkNetwork(*address, networkFacts(*address), launch.simulated));
  else
    findings.push_back({true, "LCM URL '" + launch.lcm_url + "' cannot be read",
                        "--lcm-url udpm://239.255.76.67:7667?ttl=0"});
  for (const LaunchProcess& process : launch.processes)
    add(checkProcess(processFacts(process, launch.lcm_url, settings)));
  return findings;
}

}  // namespace tread::launch
