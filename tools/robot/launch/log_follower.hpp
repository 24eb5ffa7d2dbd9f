// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include <sys/types.h>

namespace tread::launch {

/// Reads the lines that somebody appends to a log file, also after it was rotated.
class LogFollower {
 public:
  /// What stands in the file already is skipped.
  explicit LogFollower(std::string path);
  /// The whole lines that have come since the last call.
  std::vector<std::string> newLines();

 private:
  void readRest(std::vector<std::string>& lines);

  std::string path_;
  std::ifstream file_;
  ino_t inode_ = 0;
  std::string partial_;
};

}  // namespace tread::launch
