// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include <unistd.h>

#include "common/bus/host_clock.hpp"
#include "common/bus/life_sign.hpp"

namespace tread::testing {

/// Receives the messages of processes to their starter, like systemd: it is $NOTIFY_SOCKET for
/// everything that the test starts meanwhile.
class Starter {
 public:
  Starter() : listener_("/tmp/tread_starter_" + std::to_string(getpid())) {
    setenv("NOTIFY_SOCKET", listener_.path().c_str(), 1);
  }
  ~Starter() { unsetenv("NOTIFY_SOCKET"); }
  Starter(const Starter&) = delete;
  Starter& operator=(const Starter&) = delete;

  /// Number of lines from this process with this beginning.
  int count(int pid, const std::string& start) {
    hear();
    return static_cast<int>(std::count_if(lines_.begin(), lines_.end(), [&](const Line& line) {
      return line.pid == pid && line.text.rfind(start, 0) == 0;
    }));
  }
  /// The longest time between two consecutive messages [s].
  double longestSilence(int pid) const {
    double longest = 0.0;
    int64_t last = 0;
    for (const Line& line : lines_) {
      if (line.pid != pid) continue;
      if (last > 0) longest = std::max(longest, 1e-6 * static_cast<double>(line.utime - last));
      last = line.utime;
    }
    return longest;
  }

 private:
  struct Line {
    int64_t utime;  ///< [us] of receipt
    int pid;
    std::string text;
  };

  void hear() {
    while (const auto word = listener_.take()) {
      std::istringstream lines(word->lines);
      for (std::string line; std::getline(lines, line);)
        lines_.push_back({hostNow(), word->pid, line});
    }
  }

  LifeSignListener listener_;
  std::vector<Line> lines_;
};

}  // namespace tread::testing
