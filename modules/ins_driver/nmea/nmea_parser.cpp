// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/nmea/nmea_parser.hpp"

#include "common/geometry/se2.hpp"
#include "modules/ins_driver/nmea/nmea_fields.hpp"

namespace tread::ins {
namespace {

constexpr double kRadPerDeg = kPi / 180.0;
constexpr double kMpsPerKnot = 1852.0 / 3600.0;
constexpr double kMpsPerKmh = 1.0 / 3.6;
constexpr double kMaxKnots = 1000.0;              // the limit of civil receivers
constexpr double kMaxTurn = 36000.0;              // [deg/min], 100 turns a minute
constexpr std::string_view kModes = "ADEFMNPRS";  // NMEA 0183 v4.11 mode indicator

bool usable(FixQuality quality) {
  return quality != FixQuality::kNone && quality != FixQuality::kManual &&
         quality != FixQuality::kSimulator;
}

/// Not valid, typed in by hand, or simulated by the receiver.
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
  gga.geoid_separation = fields.number(11, -200.0, 200.0);
  fields.letter(12, "M");
  fields.number(13, 0.0, 1e6);  // age of corrections: read only to refuse what is not a number
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
  // With the same number of decimals km/h are the finer of the two.
  vtg.speed = speed_kmh ? speed_kmh : speed_knots;
  return usableMode(fields.letter(9, kModes)) ? vtg : Vtg{};
}

NmeaSentence readHdt(NmeaFields& fields) {
  fields.letter(2, "T");
  return Hdt{fields.yawFromHeading(1)};
}

NmeaSentence readPashr(NmeaFields& fields) {
  Pashr pashr;
  pashr.time_of_day = fields.timeOfDay(1);
  pashr.yaw = fields.yawFromHeading(2);
  fields.letter(3, "T");
  pashr.roll = fields.number(4, -180.0, 180.0, kRadPerDeg);
  pashr.pitch = fields.number(5, -90.0, 90.0, -kRadPerDeg);
  pashr.heave = fields.number(6, -1000.0, 1000.0);
  pashr.roll_std = fields.number(7, 0.0, 360.0, kRadPerDeg);
  pashr.pitch_std = fields.number(8, 0.0, 360.0, kRadPerDeg);
  pashr.yaw_std = fields.number(9, 0.0, 360.0, kRadPerDeg);
  pashr.gnss_quality = fields.integer(10, 0, 9);
  pashr.imu_status = fields.integer(11, 0, 9);
  return pashr;
}

NmeaSentence readRot(NmeaFields& fields) {
  const auto yaw_rate = fields.number(1, -kMaxTurn, kMaxTurn, -kRadPerDeg / 60.0);
  return fields.letter(2, "AV") == 'A' ? Rot{yaw_rate} : Rot{};
}

NmeaSentence readZda(NmeaFields& fields) {
  fields.number(5, -13.0, 13.0);  // local zone: UTC is what counts
  fields.integer(6, 0, 59);
  return Zda{fields.timeOfDay(1), fields.date(2)};
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

std::optional<int64_t> timeOfDay(const NmeaSentence& sentence) {
  return std::visit(
      [](const auto& s) -> std::optional<int64_t> {
        using Type = std::decay_t<decltype(s)>;
        if constexpr (std::is_same_v<Type, Vtg> || std::is_same_v<Type, Hdt> ||
                      std::is_same_v<Type, Rot>) {
          return std::nullopt;
        } else {
          return s.time_of_day;
        }
      },
      sentence);
}

ParseResult parseNmea(std::string_view body) {
  NmeaFields fields(body);
  const Reader* reader = readerFor(fields);
  if (!reader) return SentenceRefusal::kUnknownSentence;
  if (fields.count() < reader->min_fields || fields.count() > reader->max_fields)
    return SentenceRefusal::kFieldCount;
  NmeaSentence sentence = reader->read(fields);
  if (fields.refusal()) return *fields.refusal();
  return sentence;
}

}  // namespace tread::ins
