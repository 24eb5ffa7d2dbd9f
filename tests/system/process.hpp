// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/system/own_bus.hpp"

namespace tread::testing {

/// A program of Tread, run as a user runs it; killed at the end of the test if it still runs.
class Process {
 public:
  /// Starts build/<preset>/bin/<program>, or a program by its full path; appends its output to
  /// `output_file`.
  Process(const std::string& program, std::vector<std::string> arguments,
          const std::string& output_file = "/dev/null") {
    std::string path =
        program.front() == '/' ? program : std::string(TREAD_BIN_DIR) + "/" + program;
    std::vector<char*> words{path.data()};
    for (std::string& argument : arguments) words.push_back(argument.data());
    words.push_back(nullptr);
    pid_ = fork();
    if (pid_ != 0) return;
    // A test that is killed by a timeout must leave no processes.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int output = open(output_file.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
    dup2(output, 1);
    dup2(output, 2);
    execv(path.c_str(), words.data());
    _exit(127);
  }
  ~Process() {
    if (pid_ > 0 && !waitFor(0)) {
      kill(pid_, SIGKILL);
      waitFor(5);
    }
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  void signal(int number) const { kill(pid_, number); }
  bool running() { return !waitFor(0); }
  /// Waits at most `seconds` for the end; true if it has ended.
  bool waitFor(double seconds) {
    for (int i = 0; !ended_; ++i) {
      int status = 0;
      if (waitpid(pid_, &status, WNOHANG) == pid_) {
        ended_ = true;
        exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
      } else if (i * 0.01 >= seconds) {
        return false;
      } else {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
      }
    }
    return true;
  }
  int exitCode() const { return exit_code_; }
  pid_t pid() const { return pid_; }

 private:
  pid_t pid_ = -1;
  bool ended_ = false;
  int exit_code_ = -1;
};

}  // namespace tread::testing
