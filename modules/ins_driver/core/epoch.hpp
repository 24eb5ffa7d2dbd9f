// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>

#include "modules/ins_driver/core/nmea_sentence.hpp"

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

}  // namespace tread::ins
