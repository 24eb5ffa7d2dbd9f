// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <linux/capability.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

#include <catch2/catch.hpp>

#include "tests/helpers.hpp"

namespace tread::samples {

/// Troubles of a program that writes.
enum class Trouble { kNone, kUnwritable, kFullDisk, kKilled };

struct Outcome {
  int status = -1;
  int signal = 0;
  std::string complaint;  ///< output on stderr

  /// Warnings concern other things.
  bool isOneLine() const {
    size_t lines = 0;
    for (const std::string& line : testing::linesOf(complaint))
      lines += line.find(": warning: ") == std::string::npos ? 1U : 0U;
    return lines == 1;
  }
};

/// Runs in the child. A limit on file sizes fails in the middle of writing, like a full disk; a
/// program that does not ignore its signal is killed at that point.
inline void meet(Trouble trouble) {
  // Root can write everywhere, unless it lacks this capability.
  if (trouble == Trouble::kUnwritable) ::prctl(PR_CAPBSET_DROP, CAP_DAC_OVERRIDE);
  if (trouble != Trouble::kFullDisk && trouble != Trouble::kKilled) return;
  const rlimit none{0, 0};
  ::setrlimit(RLIMIT_CORE, &none);
  const rlimit tight{20, 20};
  ::setrlimit(RLIMIT_FSIZE, &tight);
  std::signal(SIGXFSZ, trouble == Trouble::kFullDisk ? SIG_IGN : SIG_DFL);
}

inline Outcome runIn(const std::string& folder, const std::string& words, Trouble trouble) {
  int ends[2];
  REQUIRE(::pipe(ends) == 0);
  const std::string line = "exec " + std::string(TREAD_BIN_DIR) + "/" + words + " >/dev/null";
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(ends[1], STDERR_FILENO);
    ::close(ends[0]);
    meet(trouble);
    if (::chdir(folder.c_str()) != 0) ::_exit(99);
    ::execl("/bin/sh", "sh", "-c", line.c_str(), static_cast<char*>(nullptr));
    ::_exit(99);
  }
  ::close(ends[1]);
  Outcome outcome;
  char piece[4096];
  for (ssize_t got; (got = ::read(ends[0], piece, sizeof piece)) > 0;)
    outcome.complaint.append(piece, static_cast<size_t>(got));
  ::close(ends[0]);
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFSIGNALED(status)) outcome.signal = WTERMSIG(status);
  if (WIFEXITED(status)) outcome.status = WEXITSTATUS(status);
  return outcome;
}

}  // namespace tread::samples
