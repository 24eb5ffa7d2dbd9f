// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/arrival_filter.hpp"

namespace tread::ins {

void ArrivalFilter::add(int64_t device_time, int64_t arrival) {
  if (!samples_.empty() && device_time < samples_.back().device_time) samples_.clear();
  const int64_t offset = arrival - device_time;
  while (!samples_.empty() && samples_.back().offset >= offset) samples_.pop_back();
  samples_.push_back({device_time, offset});
  while (samples_.front().device_time < device_time - window_us_) samples_.pop_front();
}

}  // namespace tread::ins
