// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <optional>

#include "modules/ins_driver/core/device_clock.hpp"
#include "modules/ins_driver/core/epoch.hpp"

namespace tread::ins {

/// Gathers the sentences of one instant and hands them out together.
/** An epoch ends when a sentence tells another time, when a sentence without a time comes a second
   time, after the type that is known to be the last, or when the line was quiet. Sentences without
   a time (VTG, HDT, ROT) belong to the epoch in which they arrive. Sentences older than what was
   handed out are late; if that goes on, or if the device's time falls back by more than two
   seconds, its clock was set and counting starts anew. */
class EpochCollector {
 public:
  /// `last_type`: index in NmeaSentence of the type that ends each epoch, if the device keeps an
  /// order.
  explicit EpochCollector(int64_t quiet_us, std::optional<size_t> last_type = {})
      : quiet_us_(quiet_us), last_type_(last_type) {}

  /// Takes a sentence whose first byte came at `arrival` [us]; false if it is late.
  bool push(const NmeaSentence& sentence, int64_t arrival);
  /// Says that bytes came at this time, be they a whole sentence or not.
  void noteBytes(int64_t utime) { last_bytes_ = utime; }
  /// The oldest finished epoch; ends the open one if the line has been quiet.
  std::optional<Epoch> next(int64_t now);
  /// Ends the open epoch: the link was closed, or the log is at its end.
  void finish() { close(); }

 private:
  enum class Order { kSame, kNewer, kLate, kStep };
  Order orderOf(int64_t device_time);
  bool pushTimed(const NmeaSentence& sentence, int64_t arrival, int64_t time_of_day);
  void place(const NmeaSentence& sentence, int64_t arrival, int64_t device_time);
  void placeUntimed(const NmeaSentence& sentence, int64_t arrival);
  void learnDate(const NmeaSentence& sentence, int64_t device_time);
  void open(int64_t arrival);
  void close();

  int64_t quiet_us_;
  std::optional<size_t> last_type_;
  DeviceClock clock_;
  std::optional<Epoch> epoch_;
  std::deque<Epoch> finished_;
  int64_t last_bytes_ = 0;
  std::optional<int64_t> last_device_time_;  ///< of the last epoch that told the time
  int64_t last_arrival_ = 0;                 ///< of the same
  int late_in_a_row_ = 0;
  bool clock_was_set_ = false;
};

}  // namespace tread::ins
