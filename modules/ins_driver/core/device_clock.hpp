// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

namespace tread::ins {

inline constexpr int64_t kDayUs = int64_t{86400} * 1000000;
inline constexpr int64_t kWeekUs = 7 * kDayUs;

/// A day of the Gregorian calendar.
struct CivilDate {
  int year = 1970;
  int month = 1;
  int day = 1;
};

/// Days since 1970-01-01 of a Gregorian date.
int64_t daysSinceEpoch(const CivilDate& date);
/// True for a date that the calendar has.
bool exists(const CivilDate& date);

/// Converts the device's times, which restart every day or week, to one continuous time, and to UTC
/// once a date is known.
/** Device time counts microseconds from the start of the cycle that contains the device's first
 * time. Independent of the host's clock. */
class DeviceClock {
 public:
  /// A cycle of 0: the device's times never restart.
  explicit DeviceClock(int64_t cycle_us = kDayUs) : cycle_us_(cycle_us) {}

  /// Device time of a reported time: in the cycle that is nearest to the newest accepted time.
  int64_t timeOf(int64_t told) const;
  /// Makes a device time the newest.
  void accept(int64_t device_time);
  /// nullopt before the first accepted time.
  const std::optional<int64_t>& newest() const { return newest_; }
  /// Learns the UTC [us since 1970-01-01] of a reported time, which does not become the newest.
  void learnUtc(int64_t utc, int64_t told);
  /// Microseconds since 1970-01-01 UTC, or -1 before a date is known.
  int64_t utc(int64_t device_time) const;

 private:
  int64_t cycle_us_;
  std::optional<int64_t> newest_;
  std::optional<int64_t> utc_minus_device_;
  /// UTC and reported time before the first time
  std::optional<std::pair<int64_t, int64_t>> pending_;
};

/// Microseconds from 1970-01-01 UTC to the start of GPS time, 1980-01-06.
inline constexpr int64_t kGpsEpochUs = int64_t{315964800} * 1000000;

/// UTC of a GPS time [both us]; GPS time has no leap seconds.
constexpr int64_t utcOfGps(int64_t gps_us, int64_t leap_seconds) {
  return gps_us + kGpsEpochUs - leap_seconds * 1'000'000;
}

/// Unwraps GPS weeks that a device counts modulo 1024 (10 bits; IS-GPS-200, 20.3.3.3.1.1).
class GpsWeeks {
 public:
  /// GPS time [us] of a reported week and the time in it.
  /** A first week below 1024 is taken as one after 2019-04-07, because no such device was built
   * before 1999. Later a time that differs by 1024 weeks, to within an hour, is a roll-over. */
  int64_t timeOf(int64_t week, int64_t time_of_week);
  int64_t rollovers() const { return rollovers_; }

 private:
  std::optional<int64_t> newest_;
  int64_t shift_ = 0;  ///< added to the device's times [us]
  int64_t rollovers_ = 0;
};

/// What is wrong with a device's date [us UTC] that differs from the host's by whole eras of 1024
/// weeks, to within a day; empty if it does not, or one of them is unknown (-1).
std::string rolledOver(int64_t device_utc, int64_t host_utc);

}  // namespace tread::ins
