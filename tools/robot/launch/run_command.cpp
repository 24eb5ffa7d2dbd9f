// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/launch/run_command.hpp"

#include <chrono>
#include <csignal>

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace tread::launch {
namespace {

/// Reads what a command says until it ends or the time is over.
std::string readAll(int descriptor, std::chrono::steady_clock::time_point deadline) {
  std::string output;
  char piece[1024];
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    pollfd waiting{descriptor, POLLIN, 0};
    if (left.count() <= 0 || poll(&waiting, 1, static_cast<int>(left.count())) <= 0) break;
    const ssize_t size = read(descriptor, piece, sizeof piece);
    if (size <= 0) break;
    output.append(piece, static_cast<size_t>(size));
  }
  return output;
}

}  // namespace

void becomeProgram(std::vector<std::string> words) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
}

CommandOutcome runCommand(const std::vector<std::string>& words, double seconds) {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return {127, "no pipe"};
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], 1);
    dup2(ends[1], 2);
    becomeProgram(words);
    _exit(127);
  }
  close(ends[1]);
  CommandOutcome outcome;
  const auto deadline = std::chrono::steady_clock::now() +
                        std::chrono::milliseconds(static_cast<int64_t>(1000.0 * seconds));
  outcome.output = readAll(ends[0], deadline);
  close(ends[0]);
  const bool late = std::chrono::steady_clock::now() >= deadline;
  if (late) kill(child, SIGKILL);
  int status = 0;
  if (child < 0 || waitpid(child, &status, 0) != child) return {127, "could not be started"};
  outcome.code = late ? 124 : WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  if (late) outcome.output = "took more than " + std::to_string(static_cast<int>(seconds)) + " s";
  return outcome;
}

}  // namespace tread::launch
