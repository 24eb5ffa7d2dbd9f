// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

namespace tread::motor {

/// When the INS counts as lost.
struct InsLimits {
  int64_t period_us = 20'000;        ///< of the INS [us]
  int64_t max_latency_us = 200'000;  ///< from measurement to receipt [us]
  int64_t max_future_us = 50'000;    ///< clock difference allowed [us]

  /// Longest silence allowed [us]: three periods, at least 100 ms.
  int64_t maxAge() const { return std::max<int64_t>(3 * period_us, 100'000); }
};

/// One INS message as far as motion depends on it.
struct InsNotice {
  int64_t utime = 0;   ///< [us] of the measurement
  bool usable = true;  ///< position and heading are known
};

/// Watches that the INS goes on telling where the robot is.
/** A message counts only if its utime is newer than the last one's: a source that repeats its last
    measurement is as good as silent. */
class InsWatch {
 public:
  explicit InsWatch(const InsLimits& limits) : limits_(limits) {}

  /// A message received at now [us].
  void receive(const InsNotice& notice, int64_t now);
  /// What is wrong at now [us], in words; empty = nothing.
  std::string fault(int64_t now) const;

 private:
  InsLimits limits_;
  std::optional<int64_t> received_at_;
  int64_t utime_ = 0;
  bool usable_ = false;
};

}  // namespace tread::motor
