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

  /// Takes an arrival [us host] of a device time [us]; times must not run backwards (else reset()
  /// first).
  /** Returns the host time of the device time: at most `arrival`. */
  int64_t add(int64_t device_time, int64_t arrival);
  /// Smallest offset in the window, 0 before the first arrival [us].
  int64_t offset() const { return samples_.empty() ? 0 : samples_.front().offset; }
  bool empty() const { return samples_.empty(); }
  /// The device's clock was set: forget.
  void reset() { samples_.clear(); }

 private:
  struct Sample {
    int64_t device_time;
    int64_t offset;
  };
  int64_t window_us_;
  std::deque<Sample> samples_;  ///< offsets ascending from the front: the front is the minimum
};

}  // namespace tread::ins
