// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/nmea/nmea_parser.hpp"

#include <charconv>

#include "common/geometry/se2.hpp"

namespace tread::ins {
namespace {

constexpr double kRadPerDeg = kPi / 180.0;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

bool allDigits(std::string_view text) {
  for (const char c : text) {
    if (!isDigit(c)) return false;
  }
  return !text.empty();
}

/// A decimal number: optional sign, digits with at most one point, nothing else.
std::optional<double> decimal(std::string_view text) {
  const bool plus = !text.empty() && text.front() == '+';
  if (plus) text.remove_prefix(1);
  const size_t first = !plus && !text.empty() && text.front() == '-' ? 1 : 0;
  // std::from_chars would also accept "inf" and "nan".
  if (first >= text.size() || (!isDigit(text[first]) && text[first] != '.')) return std::nullopt;
  double value = 0.0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value, std::chars_format::fixed);
  if (error != std::errc{} || stop != end) return std::nullopt;
  return value;
}

/// Value of a string of at most nine digits.
int digits(std::string_view text) {
  int value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

constexpr double kMpsPerKnot = 1852.0 / 3600.0;
constexpr double kMpsPerKmh = 1.0 / 3.6;
constexpr double kMaxKnots = 1000.0;              // limit of civil receivers
constexpr double kMaxTurn = 36000.0;              // [deg/min], 100 turns a minute
constexpr std::string_view kModes = "ADEFMNPRS";  // NMEA 0183 v4.11 mode indicator

bool usable(FixQuality quality) {
  return quality != FixQuality::kNone && quality != FixQuality::kManual &&
         quality != FixQuality::kSimulator;
}

/// Not valid, entered manually, or simulated by the receiver.
bool usableMode(char mode) {
  return mode != 'N' && mode != 'M' && mode != 'S';
}

NmeaSentence readGga(NmeaFields& fields) {
  Gga gga;
  gga.time_of_day = fields.timeOfDay(1);
  gga.position = fields.point(2);
  gga.quality = static_cast<FixQuality>(fields.integer(6, 0, 9).value_or(0));
  gga.satellites = fields.integer(7, 0, 99);
  gga.hdop = fields.number(8, 0.0, 100.0);
  gga.altitude = fields.number(9, -1000.0, 20000.0);
  fields.letter(10, "M");
  fields.number(11, -200.0, 200.0);  // geoid separation: heights stay above mean sea level
  fields.letter(12, "M");
  fields.number(13, 0.0, 1e6);  // age of corrections: parsed only to refuse non-numbers
  if (!usable(gga.quality)) gga.position.reset();
  if (!gga.position) gga.altitude.reset();
  return gga;
}

NmeaSentence readRmc(NmeaFields& fields) {
  Rmc rmc;
  rmc.time_of_day = fields.timeOfDay(1);
  const bool active = fields.letter(2, "AV") == 'A';
  rmc.position = fields.point(3);
  rmc.speed = fields.number(7, 0.0, kMaxKnots, kMpsPerKnot);
  rmc.course = fields.yawFromHeading(8);
  rmc.date = fields.shortDate(9);
  fields.number(10, 0.0, 180.0);  // magnetic variation
  fields.letter(11, "EW");
  if (!active || !usableMode(fields.letter(12, kModes)))
    return Rmc{rmc.time_of_day, {}, {}, {}, {}};
  return rmc;
}

NmeaSentence readVtg(NmeaFields& fields) {
  Vtg vtg;
  vtg.course = fields.yawFromHeading(1);
  fields.letter(2, "T");
  fields.number(3, 0.0, 360.0);  // magnetic course
  fields.letter(4, "M");
  const auto speed_knots = fields.number(5, 0.0, kMaxKnots, kMpsPerKnot);
  fields.letter(6, "N");
  const auto speed_kmh = fields.number(7, 0.0, kMaxKnots * 1.852, kMpsPerKmh);
  fields.letter(8, "K");
  // At the same number of decimals km/h have the finer resolution.
  vtg.speed = speed_kmh ? speed_kmh : speed_knots;
  return usableMode(fields.letter(9, kModes)) ? vtg : Vtg{};
}

NmeaSentence readHdt(NmeaFields& fields) {
  fields.letter(2, "T");
  return Hdt{fields.yawFromHeading(1)};
}

/// A heading without a mode may not be measured.
NmeaSentence readThs(NmeaFields& fields) {
  const auto yaw = fields.yawFromHeading(1);
  const char mode = fields.letter(2, "ADEFMNPRSV");
  return mode != '\0' && mode != 'V' && usableMode(mode) ? Ths{yaw} : Ths{};
}

NmeaSentence readPashr(NmeaFields& fields) {
  Pashr pashr;
  pashr.time_of_day = fields.timeOfDay(1);
  pashr.yaw = fields.yawFromHeading(2);
  fields.letter(3, "T");
  pashr.roll = fields.number(4, -180.0, 180.0, kRadPerDeg);
  pashr.pitch = fields.number(5, -90.0, 90.0, -kRadPerDeg);
  fields.number(6, -1000.0, 1000.0);  // heave
  pashr.roll_std = fields.number(7, 0.0, 360.0, kRadPerDeg);
  pashr.pitch_std = fields.number(8, 0.0, 360.0, kRadPerDeg);
  pashr.yaw_std = fields.number(9, 0.0, 360.0, kRadPerDeg);
  fields.integer(10, 0, 9);  // of GNSS and of the IMU: manufacturers disagree about their meaning
  fields.integer(11, 0, 9);
  return pashr;
}

NmeaSentence readRot(NmeaFields& fields) {
  const auto yaw_rate = fields.number(1, -kMaxTurn, kMaxTurn, -kRadPerDeg / 60.0);
  return fields.letter(2, "AV") == 'A' ? Rot{yaw_rate} : Rot{};
}

NmeaSentence readZda(NmeaFields& fields) {
  fields.number(5, -13.0, 13.0);  // local zone: only UTC is used
  fields.integer(6, 0, 59);
  return Zda{fields.timeOfDay(1), fields.date(2)};
}

/// Some devices omit the last field, the reference station: certain only if both units are in their
/// places.
bool endsBeforeStation(const NmeaFields& fields) {
  return fields.count() == 13 && fields.text(10) == "M" && fields.text(12) == "M";
}

struct Reader {
  std::string_view type;
  size_t min_fields;
  size_t max_fields;
  NmeaSentence (*read)(NmeaFields&);
};

// RMC got its mode in v2.3 and its navigational status in v4.1, VTG its mode in v2.3. PASHR ends
// after the GNSS quality on older NovAtel and Hemisphere devices.
constexpr Reader kReaders[] = {
    {"GGA", 14, 14, readGga}, {"RMC", 11, 13, readRmc}, {"VTG", 8, 9, readVtg},
    {"HDT", 2, 2, readHdt},   {"ROT", 2, 2, readRot},   {"ZDA", 6, 6, readZda},
    {"THS", 2, 2, readThs},
};
constexpr Reader kPashrReader = {"PASHR", 10, 11, readPashr};

bool upperCase(std::string_view text) {
  for (const char c : text) {
    if (c < 'A' || c > 'Z') return false;
  }
  return true;
}

const Reader* readerFor(const NmeaFields& fields) {
  const std::string_view address = fields.address();
  // Ashtech's own PASHR sentences have a word where this one has the time.
  const std::string_view first = fields.text(1);
  if (address == "PASHR") return first.empty() || !upperCase(first) ? &kPashrReader : nullptr;
  const bool standard = address.size() == 5 && address[0] != 'P' && upperCase(address.substr(0, 2));
  if (!standard) return nullptr;
  for (const Reader& reader : kReaders) {
    if (address.substr(2) == reader.type) return &reader;
  }
  return nullptr;
}

}  // namespace

NmeaFields::NmeaFields(std::string_view body) {
  size_t index = 0;
  for (;;) {
    const size_t comma = body.find(',');
    fields_[index] = body.substr(0, comma);
    if (comma == std::string_view::npos) break;
    if (index == kMaxFields) {
      refuse(SentenceRefusal::kFieldCount);
      break;
    }
    ++index;
    body.remove_prefix(comma + 1);
  }
  count_ = index;
}

void NmeaFields::refuse(SentenceRefusal reason) {
  if (!refusal_) refusal_ = reason;
}

std::optional<double> NmeaFields::number(size_t index, double low, double high, double scale) {
  const std::string_view field = text(index);
  if (field.empty()) return std::nullopt;
  const std::optional<double> value = decimal(field);
  if (!value) {
    refuse(SentenceRefusal::kBadField);
    return std::nullopt;
  }
  if (*value < low || *value > high) {
    refuse(SentenceRefusal::kOutOfRange);
    return std::nullopt;
  }
  return *value * scale;
}

std::optional<int> NmeaFields::integer(size_t index, int low, int high) {
  const std::string_view field = text(index);
  if (field.empty()) return std::nullopt;
  if (!allDigits(field) || field.size() > 9) {
    refuse(SentenceRefusal::kBadField);
    return std::nullopt;
  }
  const int value = digits(field);
  if (value < low || value > high) {
    refuse(SentenceRefusal::kOutOfRange);
    return std::nullopt;
  }
  return value;
}

char NmeaFields::letter(size_t index, std::string_view allowed) {
  const std::string_view field = text(index);
  if (field.empty()) return '\0';
  if (field.size() == 1 && allowed.find(field[0]) != std::string_view::npos) return field[0];
  refuse(SentenceRefusal::kBadField);
  return '\0';
}

std::optional<int64_t> NmeaFields::timeOfDay(size_t index) {
  const std::string_view field = text(index);
  if (field.empty()) return std::nullopt;
  const bool whole = field.size() == 6;
  const bool with_fraction =
      field.size() > 7 && field.size() <= 16 && field[6] == '.' && allDigits(field.substr(7));
  if (!allDigits(field.substr(0, 6)) || (!whole && !with_fraction)) {
    refuse(SentenceRefusal::kBadField);
    return std::nullopt;
  }
  const int hour = digits(field.substr(0, 2));
  const int minute = digits(field.substr(2, 2));
  const int second = digits(field.substr(4, 2));
  const bool leap_second = hour == 23 && minute == 59 && second == 60;
  if (hour > 23 || minute > 59 || (second > 59 && !leap_second)) {
    refuse(SentenceRefusal::kOutOfRange);
    return std::nullopt;
  }
  int64_t fraction = 0;
  for (size_t i = 0; i < 6; ++i)
    fraction = fraction * 10 + (7 + i < field.size() ? field[7 + i] - '0' : 0);
  return ((hour * 60 + minute) * 60 + second) * int64_t{1000000} + fraction;
}

std::optional<double> NmeaFields::angle(size_t index, size_t degree_digits, double limit,
                                        std::string_view hemispheres) {
  const std::string_view field = text(index);
  const char hemisphere = letter(index + 1, hemispheres);
  if (field.empty()) return std::nullopt;
  const size_t whole_digits = degree_digits + 2;
  const bool of_its_form =
      field.size() >= whole_digits && allDigits(field.substr(0, whole_digits)) &&
      (field.size() == whole_digits || field[whole_digits] == '.') && hemisphere != '\0';
  const std::optional<double> minutes =
      of_its_form ? decimal(field.substr(degree_digits)) : std::nullopt;
  if (!minutes) {
    refuse(SentenceRefusal::kBadField);
    return std::nullopt;
  }
  const double degrees = digits(field.substr(0, degree_digits)) + *minutes / 60.0;
  if (*minutes >= 60.0 || degrees > limit) {
    refuse(SentenceRefusal::kOutOfRange);
    return std::nullopt;
  }
  return (hemisphere == hemispheres[0] ? degrees : -degrees) * kRadPerDeg;
}

std::optional<GeoPoint> NmeaFields::point(size_t index) {
  const std::optional<double> latitude = angle(index, 2, 90.0, "NS");
  const std::optional<double> longitude = angle(index + 2, 3, 180.0, "EW");
  if (!latitude || !longitude) return std::nullopt;
  return GeoPoint{*latitude, *longitude};
}

std::optional<double> NmeaFields::yawFromHeading(size_t index) {
  const std::optional<double> heading = number(index, 0.0, 360.0, kRadPerDeg);
  if (!heading) return std::nullopt;
  return wrapAngle(kPi / 2.0 - *heading);
}

std::optional<CivilDate> NmeaFields::checked(const CivilDate& date) {
  if (exists(date)) return date;
  refuse(SentenceRefusal::kOutOfRange);
  return std::nullopt;
}

std::optional<CivilDate> NmeaFields::shortDate(size_t index) {
  const std::string_view field = text(index);
  if (field.empty()) return std::nullopt;
  if (field.size() != 6 || !allDigits(field)) {
    refuse(SentenceRefusal::kBadField);
    return std::nullopt;
  }
  const int year = digits(field.substr(4, 2));
  return checked({year < 80 ? 2000 + year : 1900 + year, digits(field.substr(2, 2)),
                  digits(field.substr(0, 2))});
}

std::optional<CivilDate> NmeaFields::date(size_t index) {
  const std::optional<int> day = integer(index, 1, 31);
  const std::optional<int> month = integer(index + 1, 1, 12);
  const std::optional<int> year = integer(index + 2, 1980, 2200);
  if (!day || !month || !year) return std::nullopt;
  return checked({*year, *month, *day});
}

std::optional<int64_t> timeOfDay(const NmeaSentence& sentence) {
  return std::visit(
      [](const auto& s) -> std::optional<int64_t> {
        using Type = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<Type, Vtg> || std::is_same_v<Type, Hdt> ||
                      std::is_same_v<Type, Rot> || std::is_same_v<Type, Zda> ||
                      std::is_same_v<Type, Ths>) {
          return std::nullopt;
        } else {
          return s.time_of_day;
        }
      },
      sentence);
}

std::string_view typeOf(std::string_view body) {
  const Reader* reader = readerFor(NmeaFields(body));
  return reader ? reader->type : std::string_view{};
}

ParseResult parseNmea(std::string_view body) {
  NmeaFields fields(body);
  const Reader* reader = readerFor(fields);
  if (!reader) return SentenceRefusal::kUnknownSentence;
  const bool counted = fields.count() >= reader->min_fields && fields.count() <= reader->max_fields;
  const bool short_gga = reader->read == readGga && endsBeforeStation(fields);
  if (!counted && !short_gga) return SentenceRefusal::kFieldCount;
  NmeaSentence sentence = reader->read(fields);
  if (fields.refusal()) return *fields.refusal();
  return sentence;
}

}  // namespace tread::ins
