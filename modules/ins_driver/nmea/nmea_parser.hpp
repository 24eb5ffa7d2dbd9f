// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <variant>

#include "modules/ins_driver/core/device_clock.hpp"
#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

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
  kAugmented = 9,  ///< not in the standard: NovAtel's code for a fix with SBAS corrections
};

// All times are UTC, microseconds since midnight. Fields that are empty or marked invalid are
// absent. Angles follow our convention: yaw counter-clockwise from east, nose down positive.

/// Position fix.
struct Gga {
  std::optional<int64_t> time_of_day;
  FixQuality quality = FixQuality::kNone;
  std::optional<GeoPoint> position;  ///< absent without a fix, and for manual or simulated ones
  std::optional<double> altitude;    ///< above mean sea level [m]; absent with the position
  std::optional<double> hdop;        ///< horizontal dilution of precision [1]
  std::optional<int> satellites;
};

/// Recommended minimum: position, speed, course, date.
struct Rmc {
  std::optional<int64_t> time_of_day;
  std::optional<GeoPoint> position;  ///< this and the following only for status A
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

/// Inertial attitude; the format of OxTS, NovAtel, Applanix, Trimble and Hemisphere, not Ashtech's
/// own.
struct Pashr {
  std::optional<int64_t> time_of_day;
  std::optional<double> yaw;   ///< [rad]
  std::optional<double> roll;  ///< right side down positive, about x forward [rad]
  /// Nose down positive, about y left [rad]; the sentence has nose up
  std::optional<double> pitch;
  std::optional<double> roll_std;   ///< [rad]
  std::optional<double> pitch_std;  ///< [rad]
  std::optional<double> yaw_std;    ///< [rad]
};

/// Rate of turn.
struct Rot {
  /// [rad/s], counter-clockwise positive; the sentence has clockwise
  std::optional<double> yaw_rate;
};

/// Time and date.
struct Zda {
  std::optional<int64_t> time_of_day;
  std::optional<CivilDate> date;
};

/// True heading and how it was measured.
struct Ths {
  std::optional<double> yaw;  ///< [rad]; absent unless measured, autonomously or by dead reckoning
};

using NmeaSentence = std::variant<Gga, Rmc, Vtg, Hdt, Pashr, Rot, Zda, Ths>;

inline constexpr size_t kSentenceTypes = std::variant_size_v<NmeaSentence>;

/// Names in the order of NmeaSentence.
inline constexpr const char* kSentenceNames[kSentenceTypes] = {"GGA",   "RMC", "VTG", "HDT",
                                                               "PASHR", "ROT", "ZDA", "THS"};

/// UTC time of day of the measurement in a sentence, if it has one [us].
/** Not for ZDA, which contains no measurement and which some devices send with the time of the next
 * second. */
std::optional<int64_t> timeOfDay(const NmeaSentence& sentence);

/// Why a sentence was not used.
enum class SentenceRefusal : uint8_t {
  kCut,              ///< a new '$' before the end of the line
  kNotPrintable,     ///< a byte that NMEA 0183 does not allow in a sentence
  kTooLong,          ///< no line end within the length limit
  kNoChecksum,       ///< the line does not end in '*' and two hexadecimal digits
  kWrongChecksum,    ///< the digits are not the exclusive-or of the sentence
  kUnknownSentence,  ///< well-formed, but not supported
  kFieldCount,       ///< more or fewer fields than this sentence has
  kBadField,         ///< a non-empty field in a wrong format
  kOutOfRange,       ///< an impossible number or date
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

/// The comma-separated fields of one sentence, parsed strictly.
/** Every reader returns nullopt for an empty field. For a field in a wrong format or out of range
 * it also returns nullopt, and refusal() keeps the first such reason. */
class NmeaFields {
 public:
  static constexpr size_t kMaxFields = 32;

  /// Splits the text between '$' and '*'.
  explicit NmeaFields(std::string_view body);

  std::string_view address() const { return fields_[0]; }
  /// Number of fields after the address.
  size_t count() const { return count_; }
  std::string_view text(size_t index) const {
    return index <= count_ ? fields_[index] : std::string_view{};
  }
  std::optional<SentenceRefusal> refusal() const { return refusal_; }

  /// Decimal number without exponent, times `scale`, its raw value within [low, high].
  std::optional<double> number(size_t index, double low, double high, double scale = 1.0);
  /// Digits only, within [low, high].
  std::optional<int> integer(size_t index, int low, int high);
  /// One character out of `allowed`; '\0' if empty.
  char letter(size_t index, std::string_view allowed);
  /// hhmmss or hhmmss.s...; second 60 is a leap second [us since midnight].
  std::optional<int64_t> timeOfDay(size_t index);
  /// ddmm.mm and dddmm.mm with their hemispheres in the four fields from `index` on.
  std::optional<GeoPoint> point(size_t index);
  /// Degrees clockwise from north in [0, 360] as a yaw in (-pi, pi] [rad].
  std::optional<double> yawFromHeading(size_t index);
  /// ddmmyy; 80 to 99 are in the last century.
  std::optional<CivilDate> shortDate(size_t index);
  /// Day, month and year in the three fields from `index` on.
  std::optional<CivilDate> date(size_t index);

 private:
  void refuse(SentenceRefusal reason);
  std::optional<double> angle(size_t index, size_t degree_digits, double limit,
                              std::string_view hemispheres);
  std::optional<CivilDate> checked(const CivilDate& date);

  std::array<std::string_view, kMaxFields + 1> fields_{};
  size_t count_ = 0;
  std::optional<SentenceRefusal> refusal_;
};

/// A sentence in SI units and our frames, or the reason for its refusal.
using ParseResult = std::variant<NmeaSentence, SentenceRefusal>;

/// The name in kSentenceNames for the text between '$' and '*'; empty if it is not supported.
std::string_view typeOf(std::string_view body);

/// Parses the text between '$' and '*' (checksum already verified).
/** GGA, RMC, VTG, HDT, THS, ROT and ZDA of any two-letter talker, and PASHR (field lists: NMEA 0183
 * v4.11; PASHR: manuals of OxTS, NovAtel and Trimble). Empty fields are absent. One malformed or
 * impossible field refuses the sentence. GGA may lack its last field, the reference station. */
ParseResult parseNmea(std::string_view body);

}  // namespace tread::ins
