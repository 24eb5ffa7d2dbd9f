// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <variant>

#include "modules/ins_driver/core/local_frame.hpp"

namespace tread::ins {

/// A day of the Gregorian calendar.
struct CivilDate {
  int year = 1970;
  int month = 1;
  int day = 1;
};

/// Fix quality of GGA (NMEA 0183 v4.11, GGA field 6).
enum class FixQuality : uint8_t {
  kNone = 0,
  kStandard = 1,
  kDifferential = 2,
  kPrecise = 3,
  kRtkFixed = 4,
  kRtkFloat = 5,
  kEstimated = 6,
  kManual = 7,
  kSimulator = 8,
  kAugmented = 9,  ///< not of the standard: NovAtel's word for a fix with SBAS corrections
};

// All times are UTC, microseconds since midnight. A field that the device left empty, or that it
// marks as invalid, is absent. Angles are in the house's sense: yaw counter-clockwise from east,
// nose down positive.

/// Position fix.
struct Gga {
  std::optional<int64_t> time_of_day;
  FixQuality quality = FixQuality::kNone;
  std::optional<GeoPoint> position;  ///< absent without a fix, and for typed-in or simulated ones
  std::optional<double> altitude;    ///< above mean sea level [m]; absent with the position
  std::optional<double> hdop;        ///< horizontal dilution of precision [1]
  std::optional<int> satellites;
};

/// Recommended minimum: position, speed, course, date.
struct Rmc {
  std::optional<int64_t> time_of_day;
  std::optional<GeoPoint> position;  ///< this and the following only if the status is A
  std::optional<double> speed;       ///< over ground [m/s]
  std::optional<double> course;      ///< direction of motion as a yaw [rad]
  std::optional<CivilDate> date;
};

/// Course and speed over ground.
struct Vtg {
  std::optional<double> speed;   ///< [m/s]
  std::optional<double> course;  ///< direction of motion as a yaw [rad]
};

/// True heading.
struct Hdt {
  std::optional<double> yaw;  ///< [rad]
};

/// Inertial attitude; the form of OxTS, NovAtel, Applanix, Trimble and Hemisphere, not Ashtech's
/// own.
struct Pashr {
  std::optional<int64_t> time_of_day;
  std::optional<double> yaw;    ///< [rad]
  std::optional<double> roll;   ///< right side down positive, about x forward [rad]
  std::optional<double> pitch;  ///< nose down positive, about y left [rad]; the device says nose up
  std::optional<double> roll_std;   ///< [rad]
  std::optional<double> pitch_std;  ///< [rad]
  std::optional<double> yaw_std;    ///< [rad]
};

/// Rate of turn.
struct Rot {
  std::optional<double>
      yaw_rate;  ///< [rad/s], counter-clockwise positive; the device says clockwise
};

/// Time and date.
struct Zda {
  std::optional<int64_t> time_of_day;
  std::optional<CivilDate> date;
};

using NmeaSentence = std::variant<Gga, Rmc, Vtg, Hdt, Pashr, Rot, Zda>;

inline constexpr size_t kSentenceTypes = std::variant_size_v<NmeaSentence>;

/// Names in the order of NmeaSentence.
inline constexpr const char* kSentenceNames[kSentenceTypes] = {"GGA",   "RMC", "VTG", "HDT",
                                                               "PASHR", "ROT", "ZDA"};

/// UTC time of day of a sentence, where it has one [us].
std::optional<int64_t> timeOfDay(const NmeaSentence& sentence);

/// Why a sentence was not used.
enum class SentenceRefusal : uint8_t {
  kCut,              ///< a new '$' came before the end of the line
  kNotPrintable,     ///< a byte that NMEA 0183 does not allow in a sentence
  kTooLong,          ///< no line end within the length limit
  kNoChecksum,       ///< the line does not end in '*' and two hexadecimal digits
  kWrongChecksum,    ///< the digits are not the exclusive-or of the sentence
  kUnknownSentence,  ///< well-formed, but not one of ours
  kFieldCount,       ///< more or fewer fields than this sentence has
  kBadField,         ///< a field that is not empty and not of its form
  kOutOfRange,       ///< a number or date that cannot be
  kLate,             ///< its epoch has already been published
  kCount
};

inline constexpr size_t kRefusalCount = static_cast<size_t>(SentenceRefusal::kCount);

/// The reason in words, as counters and reports print it.
constexpr const char* name(SentenceRefusal reason) {
  constexpr const char* kNames[kRefusalCount] = {
      "cut short",        "not printable", "too long",  "no checksum",  "wrong checksum",
      "unknown sentence", "field count",   "bad field", "out of range", "late"};
  return reason < SentenceRefusal::kCount ? kNames[static_cast<size_t>(reason)] : "?";
}

/// How often each reason applied.
struct SentenceRefusals {
  std::array<int64_t, kRefusalCount> of{};

  void add(SentenceRefusal reason) { ++of[static_cast<size_t>(reason)]; }
  int64_t operator[](SentenceRefusal reason) const { return of[static_cast<size_t>(reason)]; }

  int64_t total() const {
    int64_t sum = 0;
    for (const int64_t count : of) sum += count;
    return sum;
  }
};

}  // namespace tread::ins
