// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/launch_file.hpp"

#include <algorithm>
#include <filesystem>

#include "common/report/text.hpp"

namespace tread::launch {
namespace {

namespace fs = std::filesystem;

using Placeholders = std::map<std::string, std::string>;

/// LCM's default group and port; the buffer holds a burst of map tiles if net.core.rmem_max allows
/// it.
constexpr const char* kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=2097152";

/// Signs of life come every 0.25 s, on a busy host later.
constexpr double kShortestWatchdog = 1.0;

bool isName(const std::string& text) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
  };
  return !text.empty() && text.size() <= 32 && text.front() != '-' &&
         std::all_of(text.begin(), text.end(), allowed);
}

void checkName(const ConfigReader& reader, const std::string& key, const std::string& name) {
  if (!isName(name))
    throw reader.error(
        key, "'" + name + "' is no name; allowed are 1 to 32 of a-z, 0-9, - and _, not - first");
}

std::string known(const Placeholders& placeholders) {
  std::string words;
  for (const auto& [name, value] : placeholders)
    words += (words.empty() ? "{" : ", {") + name + "}";
  return words;
}

/// Replaces the placeholders in the text of `key`.
std::string replaced(const ConfigReader& reader, const std::string& key, const std::string& text,
                     const Placeholders& placeholders) {
  std::string result;
  for (size_t at = 0; at < text.size(); ++at) {
    if (static_cast<unsigned char>(text[at]) < ' ')
      throw reader.error(key, "has a control character; plain text is needed");
    if (text[at] != '{') {
      result += text[at];
      continue;
    }
    const size_t end = text.find('}', at);
    const std::string name = end == std::string::npos ? "" : text.substr(at + 1, end - at - 1);
    const auto found = placeholders.find(name);
    if (found == placeholders.end())
      throw reader.error(key, "'" + text.substr(at, end == std::string::npos ? end : end - at + 1) +
                                  "' stands for nothing; known are " + known(placeholders));
    result += found->second;
    at = end;
  }
  return result;
}

std::string absolutePath(const std::string& path, const std::string& folder) {
  return (fs::path(folder) / path).lexically_normal().string();
}

/// Reads the file's own placeholders; those of the command line override them.
void readValues(ConfigReader& reader, const LaunchSettings& settings, const std::string& folder,
                Placeholders& placeholders) {
  ConfigReader values = reader.section("values");
  std::string names;
  for (const std::string& key : values.keys()) {
    std::string value;
    values.text(key, value, true);
    checkName(values, key, key);
    if (!placeholders.emplace(key, value).second)
      throw values.error(key, "is a built-in placeholder; choose another name");
    names += (names.empty() ? "" : ", ") + key;
  }
  for (const auto& [key, value] : settings.values) {
    if (!values.has(key))
      throw ConfigError(settings.file + ": has no value '" + key + "' to set; there " +
                        (names.empty() ? "are none" : "is " + names));
    placeholders[key] = value;
  }
  // A value that names a file relative to the launch file becomes absolute, so that processes find
  // it from any folder.
  for (const std::string& key : values.keys()) {
    const std::string path = absolutePath(placeholders[key], folder);
    if (placeholders[key].find('/') != std::string::npos && fs::exists(path))
      placeholders[key] = path;
  }
}

LaunchProcess readProcess(ConfigReader& reader, const Placeholders& placeholders,
                          const std::string& folder) {
  LaunchProcess process;
  reader.text("name", process.name, true);
  checkName(reader, "name", process.name);
  reader.text("program", process.program, true);
  reader.text("config", process.config);
  reader.texts("arguments", process.arguments);
  reader.flag("external", process.external);
  reader.choice("stop_signal", process.stop_signal, {"INT", "TERM", "HUP", "QUIT"});
  reader.integer("stop_time", process.stop_time, {1, 60}, "s");
  reader.number("start_time", process.start_time, {1, 600}, "s");
  reader.number("watchdog", process.watchdog, {0, 600}, "s");
  if (process.external && !process.config.empty())
    throw reader.error("config",
                       "is for programs of Tread; give it to an external one in arguments");
  for (const char* key : {"start_time", "watchdog"})
    if (process.external && reader.has(key))
      throw reader.error(key, "is for programs of Tread; an external one sends no signs of life");
  if (process.watchdog > 0.0 && process.watchdog < kShortestWatchdog)
    throw reader.error("watchdog", formatted("is %g s; allowed 0 (not watched) or from %g s on",
                                             process.watchdog, kShortestWatchdog));
  process.program = replaced(reader, "program", process.program, placeholders);
  if (process.program.empty()) throw reader.error("program", "is empty; name a program");
  if (process.program.find('/') != std::string::npos)
    process.program = absolutePath(process.program, folder);
  process.config = replaced(reader, "config", process.config, placeholders);
  if (!process.config.empty()) process.config = absolutePath(process.config, folder);
  for (std::string& argument : process.arguments)
    argument = replaced(reader, "arguments", argument, placeholders);
  return process;
}

/// An empty path would silently start a robot without a key.
std::string keyPath(const ConfigReader& reader, const std::string& text,
                    const Placeholders& placeholders, const std::string& folder) {
  const std::string path = replaced(reader, "key", text, placeholders);
  if (path.empty()) throw reader.error("key", "is empty; name a file, or leave it out");
  if (path == "none") return "";
  return absolutePath(path, folder);
}

}  // namespace

std::string readLaunchName(const std::string& file) {
  ConfigReader reader = ConfigReader::fromFile(file);
  std::string name;
  reader.text("name", name, true);
  checkName(reader, "name", name);
  return name;
}

LaunchFile readLaunchFile(ConfigReader& reader, const LaunchSettings& settings) {
  LaunchFile launch;
  const std::string folder = fs::path(settings.file).parent_path().string();
  reader.text("name", launch.name, true);
  checkName(reader, "name", launch.name);
  launch.lcm_url = kDefaultUrl;
  reader.text("lcm_url", launch.lcm_url);
  if (!settings.lcm_url.empty()) launch.lcm_url = settings.lcm_url;
  reader.flag("simulated", launch.simulated);
  Placeholders placeholders{
      {"run", settings.run}, {"bin", settings.bin}, {"here", folder}, {"lcm_url", launch.lcm_url}};
  readValues(reader, settings, folder, placeholders);
  reader.text("key", launch.key);
  launch.makes_key = !reader.has("key") && !launch.simulated;
  if (reader.has("key")) launch.key = keyPath(reader, launch.key, placeholders, folder);
  if (launch.makes_key) launch.key = settings.run + "/key";
  reader.text("pre_drive", launch.pre_drive);
  launch.pre_drive = replaced(reader, "pre_drive", launch.pre_drive, placeholders);
  if (!launch.pre_drive.empty()) launch.pre_drive = absolutePath(launch.pre_drive, folder);
  std::set<std::string> names{
      "supervisor"};  // reserved: supervisor.log is next to the processes' logs
  for (ConfigReader& item : reader.sections("processes", true)) {
    launch.processes.push_back(readProcess(item, placeholders, folder));
    if (!names.insert(launch.processes.back().name).second)
      throw item.error("name", "'" + launch.processes.back().name + "' is taken; choose another");
  }
  if (launch.processes.empty()) throw reader.error("processes", "is empty; nothing to start");
  reader.finish();
  return launch;
}

RunPaths::RunPaths(const std::string& run)
    : folder(run),
      lock(run + "/lock"),
      life(run + "/life.sock"),
      hung(run + "/hung"),
      status(run + "/status"),
      pid(run + "/supervisor.pid"),
      logs(run + "/log"),
      supervisor_log(run + "/log/supervisor.log") {}

std::vector<std::string> startCommand(const LaunchProcess& process, const std::string& program,
                                      const std::string& lcm_url, const std::string& key) {
  std::vector<std::string> words;
  if (process.external) {
    words = {"setpriv", "--pdeathsig", process.stop_signal, "--", program};
    words.insert(words.end(), process.arguments.begin(), process.arguments.end());
    return words;
  }
  words.push_back(program);
  if (!process.config.empty()) words.insert(words.end(), {"--config", process.config});
  words.insert(words.end(), {"--lcm-url", lcm_url, "--with-parent"});
  if (!key.empty()) words.insert(words.end(), {"--key", key});
  words.insert(words.end(), process.arguments.begin(), process.arguments.end());
  return words;
}

std::vector<std::string> checkCommand(const LaunchProcess& process, const std::string& program,
                                      const std::string& lcm_url) {
  if (process.external) return {};
  std::vector<std::string> words = startCommand(process, program, lcm_url);
  std::replace(words.begin(), words.end(), std::string("--with-parent"), std::string("--check"));
  return words;
}

}  // namespace tread::launch
