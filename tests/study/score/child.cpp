// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/score/child.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstring>
#include <fstream>
#include <stdexcept>

namespace tread::blindtest {
namespace {

constexpr int kCannotStart = 127;

/// Runs in the child and does not return. It uses only system calls, the only safe ones between
/// fork and exec in a program with threads.
[[noreturn]] void become(const Child& child, char* const* arguments) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (chdir(child.folder.c_str()) != 0) _exit(kCannotStart);
  if (child.cpu_limit > 0) {
    const auto seconds = static_cast<rlim_t>(child.cpu_limit);
    const rlimit limit{seconds, seconds};
    setrlimit(RLIMIT_CPU, &limit);
  }
  const int log = open(child.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (log < 0) _exit(kCannotStart);
  dup2(log, STDOUT_FILENO);
  dup2(log, STDERR_FILENO);
  execv(arguments[0], arguments);
  _exit(kCannotStart);
}

double secondsOf(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

Ended run(const Child& child) {
  std::vector<char*> arguments;
  for (const std::string& word : child.command)
    arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t pid = fork();
  if (pid < 0)
    throw std::runtime_error(std::string("no process can be started: ") + strerror(errno));
  if (pid == 0) become(child, arguments.data());
  int status = 0;
  rusage used{};
  while (wait4(pid, &status, 0, &used) < 0)
    if (errno != EINTR) throw std::runtime_error("a child is lost");
  Ended ended;
  ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  ended.cpu_seconds = secondsOf(used.ru_utime) + secondsOf(used.ru_stime);
  if (ended.status == kCannotStart)
    throw std::runtime_error(child.command.front() + ": cannot be started");
  return ended;
}

void runOrThrow(const Child& child) {
  if (run(child).status == 0) return;
  const std::string said = lastLine(child.folder + "/" + child.log);
  throw std::runtime_error(child.command.front() + " failed: " + said);
}

std::string lastLine(const std::string& path) {
  std::ifstream file(path);
  std::string last;
  for (std::string line; std::getline(file, line);)
    if (!line.empty()) last = line;
  return last;
}

}  // namespace tread::blindtest
