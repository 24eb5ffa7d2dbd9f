// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "modules/ins_driver/core/device_clock.hpp"
#include "modules/ins_driver/core/device_epoch.hpp"

namespace tread::ins {

/// Gathers the messages of one instant and hands them out together.
/** An epoch ends when a message tells another time, when a message without a time comes a second
   time, after the kind that is known to be the last, or when the line was quiet. Messages without a
   time (NMEA: VTG, HDT, ROT) belong to the epoch in which they arrive. Messages older than what was
   handed out are late; if that goes on, or if the device's time falls back by more than two
   seconds, its clock was set and counting starts anew. */
class EpochCollector {
 public:
  /// `last_kind`: of the message that ends each epoch, if the device keeps an order. `cycle_us`: of
  /// the times that the device tells, as in DeviceClock.
  explicit EpochCollector(int64_t quiet_us, std::optional<size_t> last_kind = {},
                          int64_t cycle_us = kDayUs)
      : quiet_us_(quiet_us), last_kind_(last_kind), clock_(cycle_us) {}

  /// Takes what a message said whose first byte came at `arrival` [us]; false if it is late.
  /** `told`: its time as the device counts [us], if it has one. A device_utc in it is the UTC of
     that time. */
  bool push(const DeviceEpoch& part, size_t kind, std::optional<int64_t> told, int64_t arrival);
  /// Takes a message that tells only the date: it neither opens nor ends an epoch by its time,
  /// because some devices tell the time of the next second with it.
  void pushDate(int64_t utc, int64_t told, size_t kind);
  /// The newest device time; nothing before the first.
  const std::optional<int64_t>& newest() const { return clock_.newest(); }
  /// Device time of a told time.
  int64_t timeOf(int64_t told) const { return clock_.timeOf(told); }
  /// Says that bytes came at this time, be they a whole message or not.
  void noteBytes(int64_t utime) { last_bytes_ = utime; }
  /// The oldest finished epoch; ends the open one if the line has been quiet.
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
  std::optional<int64_t> last_device_time_;  ///< of the last epoch that told the time
  int64_t last_arrival_ = 0;                 ///< of the same
  int late_in_a_row_ = 0;
  bool clock_was_set_ = false;
};

}  // namespace tread::ins
