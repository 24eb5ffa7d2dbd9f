// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/helpers.hpp"
#include "tests/system/process.hpp"

namespace tread::testing {

/// True as soon as `condition` is, false on timeout.
inline bool within(double seconds, const std::function<bool()>& condition) {
  const auto deadline = std::chrono::steady_clock::now() +
                        std::chrono::milliseconds(static_cast<int64_t>(1000.0 * seconds));
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

using tread::testing::contentOf;

/// The findings without advice, line by line: a host may have little disk space or small buffers.
inline std::vector<std::string> withoutAdvice(const std::string& output) {
  std::istringstream all(output);
  std::vector<std::string> lines;
  for (std::string line; std::getline(all, line);)
    if (line.find(": advice: ") == std::string::npos) lines.push_back(line);
  return lines;
}

/// A launch file with stand-ins in a temporary folder, and tread-launch running it.
class Launched {
 public:
  /// `natures` are those of the stand-ins p0, p1, ...: good, deaf, brief, wrong (see there);
  /// further keys may follow a nature. The last process is an external one, unaware of its parent.
  /// `more` are further lines of the file.
  explicit Launched(const std::vector<std::string>& natures, const std::string& stand_in,
                    const std::string& more = "simulated: true\n")
      : folder(std::filesystem::temp_directory_path() /
               ("tread_launch_" + std::to_string(getpid()) + "_" + std::to_string(count()))) {
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    std::ofstream file(folder / "trial.yaml");
    file << "name: trial\nlcm_url: " << launchedLcmUrl() << "\n" << more << "processes:\n";
    for (size_t i = 0; i < natures.size(); ++i) {
      const std::string name = "p" + std::to_string(i);
      const size_t end = natures[i].find(' ');
      std::ofstream(folder / (name + ".txt")) << natures[i].substr(0, end);
      file << "  - {name: " << name << ", program: " << stand_in << ", config: " << name
           << ".txt, arguments: [\"{run}\"], stop_time: 2"
           << (end == std::string::npos ? "" : "," + natures[i].substr(end)) << "}\n";
    }
    file << "  - {name: other, program: sleep, arguments: [\"1000\"], external: true, "
            "stop_time: 2}\n";
  }
  ~Launched() {
    for (const int pid : pids()) kill(pid, SIGKILL);
    // The supervisor removes its own files meanwhile.
    std::error_code none;
    std::filesystem::remove_all(folder, none);
  }
  Launched(const Launched&) = delete;
  Launched& operator=(const Launched&) = delete;

  std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> words{(folder / "trial.yaml").string(), "--run", run().string()};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  std::filesystem::path run() const { return folder / "run"; }
  std::filesystem::path output() const { return folder / "output.txt"; }
  std::string said() const { return contentOf(output()); }
  bool says(const std::string& text, double seconds = 20.0) const {
    return within(seconds, [&] { return said().find(text) != std::string::npos; });
  }

  /// All processes that work in the run folder, except for the supervisor.
  std::vector<int> pids() const {
    std::vector<int> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
      const std::string name = entry.path().filename().string();
      if (name.find_first_not_of("0123456789") != std::string::npos) continue;
      std::error_code gone;
      const auto place = std::filesystem::read_symlink(entry.path() / "cwd", gone);
      if (gone || place != run()) continue;
      if (std::stoi(name) != supervisor()) found.push_back(std::stoi(name));
    }
    return found;
  }
  /// The one with this word in its command line; 0 if none.
  int pidOf(const std::string& word) const {
    for (const int pid : pids())
      if (contentOf("/proc/" + std::to_string(pid) + "/cmdline").find(word) != std::string::npos)
        return pid;
    return 0;
  }
  int supervisor() const {
    const std::string text = contentOf(run() / "supervisor.pid");
    return text.empty() ? 0 : std::stoi(text);
  }

  const std::filesystem::path folder;

 private:
  static int count() {
    static int number = 0;
    return number++;
  }
};

}  // namespace tread::testing
