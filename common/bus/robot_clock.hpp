// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>

namespace tread {

/// By how much the robot's clock is ahead of this machine's.
/** Estimated from the times of the robot's messages and of their receipt: the message with the
 * shortest delay gives the best estimate. Only the newest 5 to 10 s are used, so that clocks may
 * drift. */
class RobotClock {
 public:
  /// A message of this utime was received at `host`, both [us].
  void observe(int64_t utime, int64_t host);
  /// [us]; nullopt before the first message
  std::optional<int64_t> offset() const;

 private:
  static constexpr int64_t kSpan = 5'000'000;  ///< [us]

  std::optional<int64_t> before_;  ///< largest offset of the span before this one
  std::optional<int64_t> now_;     ///< largest offset of this span so far
  int64_t span_began_ = 0;
};

}  // namespace tread
