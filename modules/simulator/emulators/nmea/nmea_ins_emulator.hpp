// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <string_view>

#include <GeographicLib/LocalCartesian.hpp>

#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// How often the INS sends a sentence: with every n-th measurement, 0 = never.
struct NmeaRates {
  int zda = 50;
  int rmc = 50;
  int gga = 1;
  int vtg = 1;
  int hdt = 1;
  int pashr = 1;
  int rot = 1;
};

/// Position and time of the emulated INS, and its sentences.
struct NmeaInsSettings : MapOnEarth {
  NmeaRates rates;
};

/// Faults of the device or its line.
struct NmeaInsFaults {
  bool silent = false;         ///< sends nothing
  bool no_fix = false;         ///< no satellites: positions and velocities are empty
  bool no_heading = false;     ///< HDT is empty, PASHR is missing
  double garbage_share = 0.0;  ///< probability of random bytes before a sentence
  double corrupt_share = 0.0;  ///< probability that one character of a sentence is changed
  double cut_share = 0.0;      ///< probability that a sentence breaks off
};

/// An INS with NMEA 0183: ZDA, RMC, GGA, VTG, HDT, PASHR, ROT, in this order per measurement.
/** Map axes are east, north, up at the origin (GeographicLib's LocalCartesian). Heading is
 * clockwise from north; PASHR's roll is positive with the left side up, its pitch with the bow up;
 * ROT is in degrees a minute, negative to the left. All times in sentences are UTC of the
 * measurement. */
class NmeaInsEmulator final : public InsEmulator {
 public:
  NmeaInsEmulator(const NmeaInsSettings& settings, uint64_t seed);

  /// The device takes no commands; bytes to it are ignored.
  void receive(std::string_view /*bytes*/, int64_t /*utime*/) override {}
  void add(const InsMeasurement& sample) override;
  std::string transmit(int64_t utime) override;
  void setFaults(const NmeaInsFaults& faults) { faults_ = faults; }

 private:
  struct Fix;
  Fix fixOf(const InsMeasurement& sample) const;
  void sayPlace(int64_t n, const Fix& fix);
  void sayMotion(int64_t n, const Fix& fix, const InsMeasurement& sample);
  void say(const std::string& body);
  double chance();

  NmeaInsSettings settings_;
  GeographicLib::LocalCartesian map_;
  NmeaInsFaults faults_;
  std::mt19937_64 random_;
  int64_t count_ = 0;
  std::string out_;
};

}  // namespace tread::sim
