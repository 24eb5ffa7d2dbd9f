// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <vector>

namespace tread::motor {

/// The most recent times between commands to the controller: how regular the stream is.
class CommandPeriods {
 public:
  static constexpr size_t kMost = 512;

  /// A command was sent at a time [us].
  void sent(int64_t utime) {
    if (last_ > 0 && utime > last_) periods_.push_back(utime - last_);
    last_ = utime;
    if (periods_.size() > kMost) periods_.pop_front();
  }

  struct Summary {
    int64_t least = 0;  ///< [us]
    int64_t median = 0;
    int64_t longest = 0;
  };
  /// All 0 until two commands were sent.
  Summary summary() const {
    if (periods_.empty()) return {};
    std::vector<int64_t> sorted(periods_.begin(), periods_.end());
    std::sort(sorted.begin(), sorted.end());
    return {sorted.front(), sorted[sorted.size() / 2], sorted.back()};
  }

 private:
  std::deque<int64_t> periods_;
  int64_t last_ = 0;
};

}  // namespace tread::motor
