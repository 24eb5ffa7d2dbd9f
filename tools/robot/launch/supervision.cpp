// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/supervision.hpp"

#include "tools/robot/launch/host.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/report/text.hpp"
#include "tools/robot/launch/process_keeper.hpp"

namespace tread::launch {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLongestStop = 120.0;  // s

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Parent pid in the text of /proc/PID/stat; 0 if it cannot be read.
pid_t parentIn(const std::string& stat) {
  const size_t bracket = stat.rfind(") ");  // a program name may contain blanks and brackets
  pid_t parent = 0;
  if (bracket == std::string::npos || std::sscanf(stat.c_str() + bracket, ") %*c %d", &parent) != 1)
    return 0;
  return parent;
}

/// 0 if there is no such process.
pid_t parentOf(const std::string& pid) {
  std::ifstream file("/proc/" + pid + "/stat");
  return parentIn({std::istreambuf_iterator<char>(file), {}});
}

std::vector<pid_t> children() {
  std::vector<pid_t> pids;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    if (parentOf(name) == getpid()) pids.push_back(std::stoi(name));
  }
  return pids;
}

/// Sends SIGTERM to all children of this process, and SIGKILL to those that remain after
/// `stop_time` seconds.
void endChildren(double stop_time) {
  const auto deadline = std::chrono::steady_clock::now() +
                        std::chrono::milliseconds(static_cast<int64_t>(1000.0 * stop_time));
  for (const pid_t pid : children()) kill(pid, SIGINT);
  for (;;) {
    const pid_t pid = waitpid(-1, nullptr, WNOHANG);
    if (pid < 0) return;  // no children left
    if (pid > 0) continue;
    // A halted process reacts only to SIGKILL; a grandchild may become our child late.
    if (std::chrono::steady_clock::now() > deadline)
      for (const pid_t child : children()) kill(child, SIGKILL);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

/// True under nohup: this process outlives its terminal.
bool ignoresHangup() {
  struct sigaction now {};
  return sigaction(SIGHUP, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

/// One run of a supervisor.
class Run {
 public:
  Run(std::string name, RunPaths paths) : name_(std::move(name)), paths_(std::move(paths)) {}

  void begin(const std::vector<SupervisedProcess>& processes, const RunLock& lock, bool watch);
  /// Waits until the supervisor has ended.
  void wait();
  /// Reports how it ended; returns the exit code.
  int conclude() const;

 private:
  void stop();
  void reap();

  std::string name_;
  RunPaths paths_;
  Clock::time_point stop_{};
  sigset_t waited_{};
  pid_t supervisor_ = -1;
  bool stopping_ = false;
  bool ended_ = false;
  int status_ = 0;
};

void Run::begin(const std::vector<SupervisedProcess>& processes, const RunLock& lock, bool watch) {
  sigset_t before;
  sigemptyset(&waited_);
  for (const int number : {SIGINT, SIGTERM, SIGCHLD}) sigaddset(&waited_, number);
  if (!ignoresHangup()) sigaddset(&waited_, SIGHUP);
  sigprocmask(SIG_BLOCK, &waited_, &before);
  std::signal(SIGPIPE, SIG_IGN);  // the reader of our output may leave
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  const pid_t parent = getpid();
  supervisor_ = fork();
  if (supervisor_ == 0) becomeKeeper({name_, processes, paths_, watch, before}, lock, parent);
  if (supervisor_ < 0) throw std::runtime_error("no further process can be started");
}

void Run::wait() {
  while (!ended_) {
    const int number = sigwaitinfo(&waited_, nullptr);
    if (number > 0 && number != SIGCHLD) stop();
    reap();
  }
}

void Run::stop() {
  kill(supervisor_, SIGTERM);  // before writing: a terminal that nobody reads may block us
  if (!stopping_) {
    stop_ = Clock::now();
    std::cout << name_ << ": stopping" << std::endl;
  }
  stopping_ = true;
}

void Run::reap() {
  int status = 0;
  for (pid_t pid = 0; (pid = waitpid(-1, &status, WNOHANG)) > 0;) {
    if (pid != supervisor_) continue;
    ended_ = true;
    status_ = status;
  }
}

int Run::conclude() const {
  const bool clean = WIFEXITED(status_) && WEXITSTATUS(status_) == 0;
  if (stopping_ && clean) {
    std::cout << name_ << ": stopped after " << formatted("%.1f s", secondsSince(stop_))
              << std::endl;
    return 0;
  }
  std::cerr << name_ << ": the supervisor "
            << (WIFSIGNALED(status_) ? "was killed by signal " + std::to_string(WTERMSIG(status_))
                                     : "ended with code " + std::to_string(WEXITSTATUS(status_)))
            << ", so everything is stopped; see " << paths_.supervisor_log << std::endl;
  return 1;
}

}  // namespace

int supervise(const std::string& name, const std::vector<SupervisedProcess>& processes,
              const RunPaths& paths, const RunLock& lock, bool watch) {
  int64_t stop_time = 0;
  for (const SupervisedProcess& supervised : processes)
    stop_time = std::max(stop_time, supervised.process.stop_time);
  Run run(name, paths);
  run.begin(processes, lock, watch);
  run.wait();
  endChildren(static_cast<double>(stop_time));
  std::error_code none;
  for (const std::string& path : {paths.status, paths.pid, paths.life})
    std::filesystem::remove(path, none);
  return run.conclude();
}

int stopRun(const std::string& name, const RunPaths& paths) {
  const int pid = RunLock::owner(paths.lock);
  if (pid == 0 && !RunLock::isHeld(paths.lock)) {
    std::cout << name << ": nothing runs in " << paths.folder << std::endl;
    return 0;
  }
  const auto start = Clock::now();
  if (pid > 0 && kill(pid, SIGTERM) != 0) {
    std::cerr << name << ": pid " << pid << " cannot be stopped by this user ("
              << std::strerror(errno) << "); stop it as the user who started it" << std::endl;
    return 1;
  }
  while (RunLock::isHeld(paths.lock)) {
    if (secondsSince(start) > kLongestStop) {
      std::cerr << name << ": still runs after " << formatted("%.1f s", kLongestStop)
                << "; its supervisor's pid is in " << paths.pid << std::endl;
      return 1;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  std::cout << name << ": stopped after " << formatted("%.1f s", secondsSince(start)) << std::endl;
  return 0;
}

}  // namespace tread::launch
