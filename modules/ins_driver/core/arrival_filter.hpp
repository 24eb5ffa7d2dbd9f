// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>

namespace tread::ins {

/// Maps device time to host time so that the jitter of line, scheduler and polling stays out of the
/// measurement time.
/** A message never arrives before it was sent: the smallest (arrival - device time) of a sliding
   window is the best estimate of the clocks' offset plus the shortest way. The window bounds the
   error of a drifting device clock: 10 s times 50 ppm is 0.5 ms. */
class ArrivalFilter {
 public:
  explicit ArrivalFilter(int64_t window_us) : window_us_(window_us) {}

  /// Takes an arrival [us host] of a device time [us]. A device time before the last one means that
  /// the device's clock was set: what was known is forgotten.
  void add(int64_t device_time, int64_t arrival) {
    if (!samples_.empty() && device_time < samples_.back().device_time) samples_.clear();
    const int64_t offset = arrival - device_time;
    while (!samples_.empty() && samples_.back().offset >= offset) samples_.pop_back();
    samples_.push_back({device_time, offset});
    while (samples_.front().device_time < device_time - window_us_) samples_.pop_front();
  }
  /// Host time of a device time; for one that was added at most its arrival.
  int64_t hostTime(int64_t device_time) const { return device_time + offset(); }
  /// Smallest offset in the window, 0 before the first arrival [us].
  int64_t offset() const { return samples_.empty() ? 0 : samples_.front().offset; }

 private:
  struct Sample {
    int64_t device_time;
    int64_t offset;
  };
  int64_t window_us_;
  std::deque<Sample> samples_;  ///< offsets ascending from the front: the front is the minimum
};

}  // namespace tread::ins
