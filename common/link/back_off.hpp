// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace tread {

/// Spaces attempts to open a link: 100 ms, doubling with each failure up to 1 s.
/** The first spacing also follows a success, so that a peer that accepts and hangs up at once is
 *  not called without end. */
class BackOff {
 public:
  /// Whether an attempt may be made now; if so, it counts as made.
  bool attempt(int64_t utime) {
    // A clock that went back belongs to another run: do not wait for it to come round.
    const bool waiting = last_ && utime >= *last_ && utime < *last_ + spacing_;
    if (!waiting) last_ = utime;
    return !waiting;
  }
  void failed() {
    if (failed_before_) spacing_ = std::min(2 * spacing_, kLongest);
    failed_before_ = true;
  }
  void succeeded() {
    spacing_ = kShortest;
    failed_before_ = false;
  }

 private:
  static constexpr int64_t kShortest = 100'000;   // [us]
  static constexpr int64_t kLongest = 1'000'000;  // [us]

  std::optional<int64_t> last_;
  int64_t spacing_ = kShortest;
  bool failed_before_ = false;
};

}  // namespace tread
