// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "modules/ins_driver/nmea/nmea_parser.hpp"

namespace tread::ins {

/// The sentences that describe one instant.
struct Epoch {
  int64_t arrival = 0;  ///< host time of the first byte of the first sentence [us]
  std::optional<int64_t>
      device_time;             ///< as DeviceClock counts [us]; absent if no sentence told the time
  int64_t device_utc = -1;     ///< [us] since 1970-01-01; -1 before the device told a date
  bool clock_was_set = false;  ///< the device's clock was set, back or forth, before this epoch
  std::optional<Gga> gga;
  std::optional<Rmc> rmc;
  std::optional<Vtg> vtg;
  std::optional<Hdt> hdt;
  std::optional<Pashr> pashr;
  std::optional<Rot> rot;
  std::optional<Zda> zda;

  /// True if a sentence of the same type is already here.
  bool holds(const NmeaSentence& sentence) const;
  void take(const NmeaSentence& sentence);
  /// The device told a position here, or that it has none.
  bool speaksOfPosition() const { return gga.has_value() || rmc.has_value(); }
};

inline constexpr int64_t kDayUs = int64_t{86400} * 1000000;

/// Turns the device's times of day into one time that runs on through midnight, and into UTC once a
/// date is known.
/** Device time counts microseconds from the midnight before the device's first time. The host's
 * clock has no part. */
class DeviceClock {
 public:
  /// Device time of a time of day: of all days the one nearest to the newest accepted time.
  int64_t timeOf(int64_t time_of_day) const;
  /// Makes a device time the newest.
  void accept(int64_t device_time) { newest_ = device_time; }
  /// Nothing before the first accepted time.
  const std::optional<int64_t>& newest() const { return newest_; }
  /// Learns the date from a sentence that holds date and time of day.
  void setDate(const CivilDate& date, int64_t time_of_day, int64_t device_time);
  /// Microseconds since 1970-01-01 UTC, or -1 before a date is known.
  int64_t utc(int64_t device_time) const;

 private:
  std::optional<int64_t> newest_;
  std::optional<int64_t> utc_minus_device_;
};

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
