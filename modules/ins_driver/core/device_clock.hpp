// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>

#include "modules/ins_driver/core/nmea_sentence.hpp"

namespace tread::ins {

inline constexpr int64_t kDayUs = int64_t{86400} * 1000000;

/// Turns the device's times of day into one time that runs on through midnight, and into UTC once a
/// date is known.
/** Device time counts microseconds from the midnight before the device's first time. The host's
 * clock has no part. */
class DeviceClock {
 public:
  /// Device time of a time of day: of all days the one nearest to the newest accepted time.
  int64_t timeOf(int64_t time_of_day) const;
  /// Makes a device time the newest.
  void accept(int64_t device_time) { newest_ = device_time; }
  /// Nothing before the first accepted time.
  const std::optional<int64_t>& newest() const { return newest_; }
  /// Learns the date from a sentence that holds date and time of day.
  void setDate(const CivilDate& date, int64_t time_of_day, int64_t device_time);
  /// Microseconds since 1970-01-01 UTC, or -1 before a date is known.
  int64_t utc(int64_t device_time) const;

 private:
  std::optional<int64_t> newest_;
  std::optional<int64_t> utc_minus_device_;
};

}  // namespace tread::ins
