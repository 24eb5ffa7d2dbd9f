// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tread::motor {

/// Splits a controller's bytes into lines of printable characters.
/** Bytes below space and above '~' are dropped; an overlong line is discarded up to its end. */
class LineCutter {
 public:
  static constexpr size_t kMaxLine = 128;

  /// `end`: CR or LF; the other of the two is ignored.
  explicit LineCutter(char end = '\r') : end_(end) {}

  /// Complete lines, without empty ones.
  std::vector<std::string> push(std::string_view bytes);
  void clear();
  int64_t overlong() const { return overlong_; }
  int64_t garbageBytes() const { return garbage_; }

 private:
  char end_;
  std::string line_;
  bool discarding_ = false;
  int64_t overlong_ = 0;
  int64_t garbage_ = 0;
};

}  // namespace tread::motor
