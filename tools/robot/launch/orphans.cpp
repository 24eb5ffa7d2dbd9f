// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/orphans.hpp"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

namespace tread::launch {
namespace {

/// The parent in the text of /proc/PID/stat; 0 if it cannot be read.
pid_t parentIn(const std::string& stat) {
  const size_t bracket = stat.rfind(") ");  // a program's name may hold blanks and brackets
  pid_t parent = 0;
  if (bracket == std::string::npos || std::sscanf(stat.c_str() + bracket, ") %*c %d", &parent) != 1)
    return 0;
  return parent;
}

std::vector<pid_t> children() {
  std::vector<pid_t> pids;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    std::ifstream file(entry.path() / "stat");
    const std::string stat{std::istreambuf_iterator<char>(file), {}};
    if (parentIn(stat) == getpid()) pids.push_back(std::stoi(name));
  }
  return pids;
}

}  // namespace

void endChildren(double stop_time) {
  const auto deadline = std::chrono::steady_clock::now() +
                        std::chrono::milliseconds(static_cast<int64_t>(1000.0 * stop_time));
  for (const pid_t pid : children()) kill(pid, SIGINT);
  for (;;) {
    const pid_t pid = waitpid(-1, nullptr, WNOHANG);
    if (pid < 0) return;  // nobody is left
    if (pid > 0) continue;
    // A halted process sees nothing but SIGKILL; a grandchild may come to us late.
    if (std::chrono::steady_clock::now() > deadline)
      for (const pid_t child : children()) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace tread::launch
