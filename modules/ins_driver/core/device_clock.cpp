// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/device_clock.hpp"

#include <cmath>
#include <cstdlib>

namespace tread::ins {
namespace {

constexpr int64_t kEraUs = 1024 * kWeekUs;
constexpr int64_t kHourUs = int64_t{3600} * 1000000;

/// The time nearest to `near` among `time` plus whole cycles.
int64_t nearest(int64_t time, int64_t near, int64_t cycle_us) {
  int64_t ahead = (time - near) % cycle_us;
  if (ahead > cycle_us / 2) ahead -= cycle_us;
  if (ahead <= -cycle_us / 2) ahead += cycle_us;
  return near + ahead;
}

int daysInMonth(int year, int month) {
  constexpr int kDays[12] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
  const bool leap = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
  return month == 2 && leap ? 29 : kDays[month - 1];
}

}  // namespace

int64_t daysSinceEpoch(const CivilDate& date) {
  // Years start in March here, so that the leap day is the last; 719468 days lie between 0000-03-01
  // and 1970-01-01.
  const int64_t year = date.month > 2 ? date.year : date.year - 1;
  const int64_t month = date.month > 2 ? date.month - 3 : date.month + 9;
  const int64_t day_of_year = (153 * month + 2) / 5 + date.day - 1;
  return 365 * year + year / 4 - year / 100 + year / 400 + day_of_year - 719468;
}

bool exists(const CivilDate& date) {
  return date.month >= 1 && date.month <= 12 && date.day >= 1 &&
         date.day <= daysInMonth(date.year, date.month);
}

int64_t DeviceClock::timeOf(int64_t told) const {
  return newest_ && cycle_us_ > 0 ? nearest(told, *newest_, cycle_us_) : told;
}

void DeviceClock::accept(int64_t device_time) {
  newest_ = device_time;
  if (!pending_) return;
  utc_minus_device_ = pending_->first - timeOf(pending_->second);
  pending_.reset();
}

void DeviceClock::learnUtc(int64_t utc, int64_t told) {
  if (newest_) {
    utc_minus_device_ = utc - timeOf(told);
  } else {
    pending_ = {utc, told};
  }
}

int64_t DeviceClock::utc(int64_t device_time) const {
  return utc_minus_device_ ? *utc_minus_device_ + device_time : -1;
}

int64_t GpsWeeks::timeOf(int64_t week, int64_t time_of_week) {
  const int64_t told = week * kWeekUs + time_of_week;
  if (!newest_) shift_ = week < 1024 ? 2 * kEraUs : 0;
  int64_t time = told + shift_;
  if (newest_ && std::abs(time - *newest_) > kHourUs) {
    const int64_t continued = nearest(time, *newest_, kEraUs);
    if (std::abs(continued - *newest_) <= kHourUs) {
      ++rollovers_;
      shift_ += continued - time;
    } else {
      shift_ = week < 1024 ? 2 * kEraUs : 0;  // the device's clock was set: restart the count
    }
    time = told + shift_;
  }
  newest_ = time;
  return time;
}

std::string rolledOver(int64_t device_utc, int64_t host_utc) {
  if (device_utc < 0 || host_utc < 0) return {};
  const int64_t off = host_utc - device_utc;
  const int64_t eras = std::llround(static_cast<double>(off) / static_cast<double>(kEraUs));
  if (eras == 0 || std::abs(off - eras * kEraUs) > kDayUs) return {};
  return "the device's date is " + std::to_string(1024 * std::abs(eras)) + " weeks " +
         (eras > 0 ? "behind" : "ahead of") +
         " this host's: its GPS week number has rolled over; update its firmware (device_utc of "
         "INS "
         "is wrong, all else is right)";
}

}  // namespace tread::ins
