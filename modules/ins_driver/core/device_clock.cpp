// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/device_clock.hpp"

#include "modules/ins_driver/core/nmea_fields.hpp"

namespace tread::ins {

int64_t DeviceClock::timeOf(int64_t time_of_day) const {
  if (!newest_) return time_of_day;
  int64_t ahead = (time_of_day - *newest_) % kDayUs;
  if (ahead > kDayUs / 2) ahead -= kDayUs;
  if (ahead <= -kDayUs / 2) ahead += kDayUs;
  return *newest_ + ahead;
}

void DeviceClock::setDate(const CivilDate& date, int64_t time_of_day, int64_t device_time) {
  utc_minus_device_ = daysSinceEpoch(date) * kDayUs + time_of_day - device_time;
}

int64_t DeviceClock::utc(int64_t device_time) const {
  return utc_minus_device_ ? *utc_minus_device_ + device_time : -1;
}

}  // namespace tread::ins
