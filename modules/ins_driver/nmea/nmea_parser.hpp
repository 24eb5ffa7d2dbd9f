// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <variant>

#include "modules/ins_driver/nmea/nmea_sentence.hpp"

namespace tread::ins {

/// The comma-separated fields of one sentence, read strictly.
/** Every reader returns nothing for an empty field. A field that is not empty and not of its form,
   or not within its range, also yields nothing and is remembered: refusal() then names the first
   such reason. */
class NmeaFields {
 public:
  static constexpr size_t kMaxFields = 32;

  /// Splits what stands between '$' and '*'.
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
  /// ddmmyy; 80 to 99 are of the last century.
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

/// Days since 1970-01-01 of a Gregorian date.
int64_t daysSinceEpoch(const CivilDate& date);

/// A sentence in SI units and the house's frames, or why it is none.
using ParseResult = std::variant<NmeaSentence, SentenceRefusal>;

/// Reads what stands between '$' and '*' (checksum already verified).
/** GGA, RMC, VTG, HDT, ROT and ZDA of any two-letter talker, and PASHR (field lists: NMEA 0183
   v4.11; PASHR: manuals of OxTS, NovAtel and Trimble). Empty fields are absent. One malformed or
   impossible field refuses the sentence. */
ParseResult parseNmea(std::string_view body);

}  // namespace tread::ins
