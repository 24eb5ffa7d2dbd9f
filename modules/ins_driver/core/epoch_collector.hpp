// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "modules/ins_driver/core/device_clock.hpp"
#include "modules/ins_driver/core/device_epoch.hpp"

namespace tread::ins {

/// Collects the messages of one instant and returns them together.
/** An epoch ends when a message has another time, when a message without a time repeats, after the
 * kind that is known to be the last, or when the line was quiet. Messages without a time (NMEA:
 * VTG, HDT, ROT) belong to the epoch in which they arrive. Messages older than the returned epochs
 * are late; if that persists, or if the device's time goes back by more than two seconds, its
 * clock was set and counting restarts. */
class EpochCollector {
 public:
  /// `last_kind`: of the message that ends each epoch, if the device has a fixed order. `cycle_us`:
  /// of the device's times, as in DeviceClock.
  explicit EpochCollector(int64_t quiet_us, std::optional<size_t> last_kind = {},
                          int64_t cycle_us = kDayUs)
      : quiet_us_(quiet_us), last_kind_(last_kind), clock_(cycle_us) {}

  /// Takes the content of a message whose first byte arrived at `arrival` [us]; false if it is
  /// late.
  /** `told`: its time as the device counts [us], if it has one. A device_utc in it is the UTC of
   * that time. */
  bool push(const DeviceEpoch& part, size_t kind, std::optional<int64_t> told, int64_t arrival);
  /// Takes a message with only the date: it neither opens nor ends an epoch by its time, because
  /// some devices send the time of the next second with it.
  void pushDate(int64_t utc, int64_t told, size_t kind);
  /// The newest device time; nullopt before the first.
  const std::optional<int64_t>& newest() const { return clock_.newest(); }
  /// Device time of a reported time.
  int64_t timeOf(int64_t told) const { return clock_.timeOf(told); }
  /// Notes that bytes arrived at this time, whether or not they form a message.
  void noteBytes(int64_t utime) { last_bytes_ = utime; }
  /// The oldest complete epoch; ends the open one if the line has been quiet.
  std::optional<DeviceEpoch> next(int64_t now);
  /// Ends the open epoch: the link was closed, or the log is at its end.
  void finish() { close(); }

 private:
  enum class Order { kSame, kNewer, kLate, kStep };
  Order orderOf(int64_t device_time);
  bool pushTimed(const DeviceEpoch& part, size_t kind, int64_t told, int64_t arrival);
  void placeUntimed(const DeviceEpoch& part, size_t kind, int64_t arrival);
  void open(int64_t arrival);
  void close();

  int64_t quiet_us_;
  std::optional<size_t> last_kind_;
  DeviceClock clock_;
  std::optional<DeviceEpoch> epoch_;
  std::deque<DeviceEpoch> finished_;
  int64_t last_bytes_ = 0;
  std::optional<int64_t> last_device_time_;  ///< of the last epoch with a time
  int64_t last_arrival_ = 0;                 ///< of the same
  int late_in_a_row_ = 0;
  bool clock_was_set_ = false;
};

}  // namespace tread::ins
