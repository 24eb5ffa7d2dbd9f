// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

namespace tread::lidar {

/// Host time of a device's 32 bit microsecond counter, which wraps after 71.6 minutes.
/** The transport delay varies: the shortest of the last 10 to 20 s is taken as its constant part.
 * If the counter jumps relative to the host's clock, the device was restarted. */
class TickClock {
 public:
  /// `ticks` [us] was sent and arrived at `arrival` [us]; false if the device's counter was
  /// restarted, which discards all earlier data.
  bool observe(uint32_t ticks, int64_t arrival) {
    bool ran_on = true;
    if (device_) {
      const auto step = static_cast<int32_t>(ticks - static_cast<uint32_t>(*device_));
      ran_on = step >= 0 && std::abs(step - (arrival - arrival_)) < kMostSlip;
      device_ = *device_ + step;
    }
    if (!device_ || !ran_on) {
      device_ = ticks;
      shortest_ = before_ = INT64_MAX;
      window_start_ = arrival;
    }
    if (arrival - window_start_ > kWindow) {
      before_ = shortest_;
      shortest_ = INT64_MAX;
      window_start_ = arrival;
    }
    arrival_ = arrival;
    shortest_ = std::min(shortest_, arrival - *device_);
    return ran_on;
  }

  /// Host time at which the observed counter would have arrived with the shortest delay [us].
  int64_t hostTime() const { return *device_ + std::min(shortest_, before_); }

  void forget() { device_.reset(); }

 private:
  static constexpr int64_t kWindow = 10'000'000;   // [us]
  static constexpr int64_t kMostSlip = 2'000'000;  // [us] by which a line may delay bytes

  std::optional<int64_t> device_;  ///< [us] unwrapped
  int64_t arrival_ = 0;
  int64_t window_start_ = 0;
  int64_t shortest_ = INT64_MAX;  ///< arrival minus device time in this window
  int64_t before_ = INT64_MAX;    ///< the same in the previous window
};

}  // namespace tread::lidar
